// Sanitizer builds only: a library that was loaded stays loaded, so that the leak checker at the end can still
// name the drivers and layers whose memory tests/leaks.supp lets pass.
#include <dlfcn.h>

int dlclose(void *handle)
{
    (void)handle;
    return 0;
}
