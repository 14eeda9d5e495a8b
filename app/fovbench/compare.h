// `fovbench compare`: what got slower or worse from one CSV to another.
#ifndef APP_FOVBENCH_COMPARE_H
#define APP_FOVBENCH_COMPARE_H

int command_compare(int argc, char **argv); // the exit status: 1 where something got worse

#endif
