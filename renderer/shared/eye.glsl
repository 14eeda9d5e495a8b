// A member of one eye's constants, e.g. EYE(z, tangents). Needs `frame` as a uniform block.
//
// By selecting and not by an index: the software driver reads a uniform block at a constant place once for all lanes, at
// a computed place lane by lane. And one member at a time: it copies a whole struct that a branch chooses.
#define EYE(eye, member) ((eye) == 0u ? frame.eyes[0].member : frame.eyes[1].member)
