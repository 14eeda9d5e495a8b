#include "analysis/report/figure_file.h"

#include "analysis/report/html.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { LINE_PX = 22 }; // below the picture

// A page takes whatever sans serif it has; a file names those that it was laid out for.
static const char any_font[] = "font-family=\"sans-serif\"";
static const char fonts[] = "font-family=\"DejaVu Sans, Liberation Sans, Arial, Helvetica, sans-serif\"";

bool figure_files_begin(struct figure_files *files, char *error, size_t error_size)
{
    struct stat info;
    if (mkdir(files->folder, 0777) == 0 || (stat(files->folder, &info) == 0 && S_ISDIR(info.st_mode)))
        return true;
    snprintf(error, error_size, "%s: no folder for figures can be made: %s", files->folder,
             stat(files->folder, &info) == 0 ? "a file of that name is there" : strerror(errno));
    return false;
}

static void write_metadata(FILE *out, const struct sample *sample)
{
    fputs("<metadata>", out);
    html_printf(out, "study: %s; data SHA-256: %s; program: fovstats " FOVSTUDY_VERSION "; simulated: %s",
                sample->protocol, sample->data_hash, sample->simulated ? "yes" : "no");
    fputs("</metadata>\n", out);
}

static void write_source(FILE *out, const struct sample *sample, double width, double height)
{
    bool narrow = width < 500;
    double size = narrow ? 8 : 11;
    fprintf(out, "<text x=\"6\" y=\"%g\" font-size=\"%g\" fill=\"#565d6b\" %s>", height + LINE_PX - 7, size,
            fonts);
    html_printf(out, "%.*s, data %.16s, fovstats " FOVSTUDY_VERSION, narrow ? 20 : 40, sample->protocol,
                sample->data_hash);
    fputs("</text>\n", out);
    if (sample->simulated)
        fprintf(out,
                "<text x=\"%g\" y=\"%g\" font-size=\"%g\" font-weight=\"bold\" text-anchor=\"end\" "
                "fill=\"#8a1c1c\" %s>SIMULATED DATA%s</text>\n",
                width - 6, height + LINE_PX - 7, size, fonts, narrow ? "" : ": no person took part");
}

static void write_body(FILE *out, const char *at)
{
    for (const char *font; (font = strstr(at, any_font)); at = font + strlen(any_font)) {
        fwrite(at, 1, (size_t)(font - at), out);
        fputs(fonts, out);
    }
    fputs(at, out);
}

// A page's element as a file of its own.
static bool write_svg(FILE *out, const struct sample *sample, const char *svg)
{
    const char *box = strstr(svg, "viewBox=\""), *body = strchr(svg, '>');
    double x, y, width, height;
    if (!box || !body || box > body || sscanf(box, "viewBox=\"%lf %lf %lf %lf", &x, &y, &width, &height) != 4)
        return false;
    fprintf(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
        "xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"%g\" height=\"%g\" viewBox=\"%g %g %g %g\">\n",
        width, height + LINE_PX, x, y, width, height + LINE_PX);
    write_metadata(out, sample);
    fprintf(out, "<rect x=\"%g\" y=\"%g\" width=\"%g\" height=\"%g\" fill=\"#ffffff\"/>\n", x, y, width,
            height + LINE_PX);
    write_source(out, sample, width, height);
    write_body(out, body + 1);
    return !ferror(out);
}

static bool make_pdf(struct figure_files *files, const char *svg, const char *pdf, char *error,
                     size_t error_size)
{
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        int null = open("/dev/null", O_RDWR);
        if (null >= 0 && dup2(null, 0) >= 0 && dup2(null, 1) >= 0 && dup2(null, 2) >= 0)
            execlp("rsvg-convert", "rsvg-convert", "--format=pdf", "--output", pdf, svg, (char *)NULL);
        _exit(errno == ENOENT ? 127 : 126);
    }
    int status = 0;
    while (child > 0 && waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            break;
    if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 127) {
        files->no_pdf = true;
        return true;
    }
    if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        files->pdfs++;
        return true;
    }
    snprintf(error, error_size, "%s: rsvg-convert could not make it of %s", pdf, svg);
    return false;
}

bool figure_files_write(struct figure_files *files, const char *name, const char *svg, char *error,
                        size_t error_size)
{
    if (!svg)
        return true;
    size_t size = strlen(files->folder) + strlen(name) + 8;
    char *path = malloc(size), *pdf = malloc(size);
    bool ok = path && pdf;
    snprintf(error, error_size, "not enough memory");
    if (ok) {
        snprintf(path, size, "%s/%s.svg", files->folder, name);
        snprintf(pdf, size, "%s/%s.pdf", files->folder, name);
        FILE *out = fopen(path, "w");
        ok = out && write_svg(out, files->sample, svg);
        ok = out && fclose(out) == 0 && ok;
        if (!ok)
            snprintf(error, error_size, "%s: cannot be written: %s", path, strerror(errno));
    }
    if (ok) {
        files->svgs++;
        ok = files->no_pdf || make_pdf(files, path, pdf, error, error_size);
    }
    free(path);
    free(pdf);
    return ok;
}
