#include "app/command/output.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool output_open(struct output *output, const char *path, char *error, size_t error_size)
{
    *output = (struct output){.path = path};
    if (!path)
        return true;
    if (strcmp(path, "-") == 0) {
        output->file = stdout;
        return true;
    }
    struct stat found;
    int length = snprintf(output->temporary, sizeof output->temporary, "%s.part", path);
    errno = ENAMETOOLONG;
    if (length < (int)sizeof output->temporary && stat(path, &found) == 0 && S_ISDIR(found.st_mode))
        errno = EISDIR;
    else if (length < (int)sizeof output->temporary)
        output->file = fopen(output->temporary, "w");
    if (output->file)
        return true;
    snprintf(error, error_size, "%s cannot be written: %s", path, strerror(errno));
    return false;
}

bool output_close(struct output *output, bool keep, char *error, size_t error_size)
{
    if (!output->file)
        return true;
    FILE *file = output->file;
    output->file = NULL;
    bool ok = fflush(file) == 0 && !ferror(file);
    if (file == stdout) {
        if (!ok)
            snprintf(error, error_size, "standard output cannot be written: %s", strerror(errno));
        return ok;
    }
    ok = fclose(file) == 0 && ok;
    ok = ok && (!keep || rename(output->temporary, output->path) == 0);
    if (!ok)
        snprintf(error, error_size, "%s cannot be written: %s", output->path, strerror(errno));
    if (!ok || !keep)
        unlink(output->temporary);
    return ok;
}

bool output_make_folder(const char *path, char *error, size_t error_size)
{
    char part[4096];
    snprintf(part, sizeof part, "%s", path);
    for (char *slash = strchr(part + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(part, 0777); // a failure shows at the last part
        *slash = '/';
    }
    struct stat found;
    if (mkdir(part, 0777) == 0 || (stat(part, &found) == 0 && S_ISDIR(found.st_mode)))
        return true;
    snprintf(error, error_size, "the folder %s cannot be made: %s", path, strerror(errno));
    return false;
}
