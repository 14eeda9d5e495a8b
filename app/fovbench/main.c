// fovbench: speed against error. Without a word it measures; words are what is done with what was measured.
#include "app/command/options.h"
#include "app/fovbench/request.h"
#include "app/fovbench/sweep.h"

#include <string.h>

int main(int argc, char **argv)
{
    struct request request;
    if (argc > 1 && strcmp(argv[1], "--version") == 0) {
        printf("fovbench %s\n", FOVSTUDY_VERSION);
        return EXIT_DONE;
    }
    int status = request_read(&request, argc, argv);
    return status >= 0 ? status : sweep(&request);
}
