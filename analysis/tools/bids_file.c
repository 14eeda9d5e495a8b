#include "analysis/tools/bids_private.h"

#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool bids_fail(struct bids *bids, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(bids->error, bids->error_size, format, arguments);
    va_end(arguments);
    return false;
}

bool bids_make_folders(struct bids *bids, const char *name)
{
    char path[BIDS_PATH_SIZE];
    int size = snprintf(path, sizeof path, "%s/%s", bids->folder, name);
    if (size < 0 || size >= (int)sizeof path)
        return bids_fail(bids, "%s: the name is too long", bids->folder);
    for (char *slash = path + strlen(bids->folder) + 1; (slash = strchr(slash, '/')); slash++) {
        *slash = '\0';
        if (mkdir(path, 0777) != 0 && errno != EEXIST)
            return bids_fail(bids, "%s: cannot be made: %s", path, strerror(errno));
        *slash = '/';
    }
    return true;
}

FILE *bids_open(struct bids *bids, const char *name)
{
    char path[BIDS_PATH_SIZE];
    if (!bids_make_folders(bids, name))
        return NULL;
    snprintf(path, sizeof path, "%s/%s", bids->folder, name);
    FILE *file = fopen(path, "wb");
    if (!file)
        bids_fail(bids, "%s: cannot be written: %s", path, strerror(errno));
    return file;
}

bool bids_close(struct bids *bids, FILE *file, const char *name)
{
    bool ok = fflush(file) == 0 && !ferror(file) && fsync(fileno(file)) == 0;
    int reason = errno;
    ok = fclose(file) == 0 && ok;
    return ok || bids_fail(bids, "%s/%s: cannot be written: %s", bids->folder, name, strerror(reason));
}

void bids_run_name(const struct bids *bids, size_t run, const char *tail, char out[BIDS_PATH_SIZE])
{
    const struct bids_run *r = &bids->runs[run];
    const struct bids_session *s = &bids->sessions[r->session];
    const char *person = bids->people.items[s->person].label;
    snprintf(out, BIDS_PATH_SIZE,
             "sub-%s/ses-%" PRId64 "/beh/sub-%s_ses-%" PRId64 "_task-%s_run-%" PRId64 "_%s", person, s->number,
             person, s->number, bids->tasks.items[s->task].label, r->number, tail);
}
