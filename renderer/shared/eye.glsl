// One eye's constants. Needs `frame` as a uniform block.
//
// By a branch and not by an index: the software driver reads a uniform block at a constant place once for all lanes, at
// a computed place lane by lane (measured 2026-11-25: splat and resolve 46 ms by index from a storage buffer).
shared_eye frame_eye(uint eye)
{
    if (eye == 0u)
        return frame.eyes[0];
    return frame.eyes[1];
}
