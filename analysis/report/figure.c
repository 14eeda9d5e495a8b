#include "analysis/report/figure.h"

#include "analysis/report/html.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static const char *const files[] = {"script", "data", "figure.svg", "messages"};

static void path_in(const struct figure *figure, const char *name, char out[96])
{
    snprintf(out, 96, "%s/%s", figure->folder, name);
}

void figure_abandon(struct figure *figure)
{
    if (figure->script)
        fclose(figure->script);
    if (figure->data)
        fclose(figure->data);
    char path[96];
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        path_in(figure, files[i], path);
        unlink(path);
    }
    rmdir(figure->folder);
    *figure = (struct figure){0};
}

bool figure_begin(struct figure *figure, int width, int height, int font_px, char *error, size_t error_size)
{
    *figure = (struct figure){.folder = "/tmp/fovstats-XXXXXX"};
    if (!mkdtemp(figure->folder)) {
        snprintf(error, error_size, "no temporary folder for a figure can be made in /tmp: %s",
                 strerror(errno));
        return false;
    }
    char path[96];
    path_in(figure, "script", path);
    figure->script = fopen(path, "w");
    path_in(figure, "data", path);
    figure->data = fopen(path, "w");
    if (!figure->script || !figure->data) {
        snprintf(error, error_size, "%s: cannot be written: %s", path, strerror(errno));
        figure_abandon(figure);
        return false;
    }
    fprintf(figure->script,
            "set term svg size %d,%d dynamic noenhanced font 'sans-serif,%d' linewidth 1\n"
            "set output 'figure.svg'\n"
            "set datafile commentschars ''\n" // a '#' in a word is a letter
            "set encoding utf8\nset border 0\nunset key\n"
            "set tics nomirror scale 0 textcolor rgb '" FIGURE_INK "'\n",
            width, height, font_px);
    return true;
}

void figure_word(FILE *data, const char *text)
{
    fputc('"', data);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        fputc(*c == '"' ? '\'' : *c == '\\' ? '/' : *c < 0x20 || *c == 0x7f ? ' ' : *c, data);
    fputc('"', data);
}

void figure_cut(char *text, size_t most)
{
    if (strlen(text) <= most)
        return;
    while (most && ((unsigned char)text[most] & 0xc0) == 0x80) // within a letter of UTF-8
        most--;
    memcpy(text + most, "\u2026", sizeof "\u2026");
}

void figure_cut_word(FILE *data, const char *text, size_t most)
{
    char room[256];
    snprintf(room, sizeof room - 4, "%s", text);
    figure_cut(room, most);
    figure_word(data, room);
}

static void write_where(FILE *data, bool there, double value)
{
    if (there)
        fprintf(data, "%.6f ", value);
    else
        fputs("NaN ", data); // which gnuplot leaves out
}

void figure_interval(FILE *data, double low, double high, double least, double most)
{
    bool any = !isnan(low) && !isnan(high), below = low<least, above = high> most;
    write_where(data, any, fmax(low, least));
    write_where(data, any, fmin(high, most));
    write_where(data, any && !below, low);
    write_where(data, any && !above, high);
    write_where(data, any && below, least);
    write_where(data, any && above, most);
}

// In the child: only calls that are safe after fork().
static void become_gnuplot(const char *folder)
{
    int in = open("/dev/null", O_RDONLY);
    if (chdir(folder) == 0 && in >= 0) {
        int out = open("messages", O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (out >= 0 && dup2(in, 0) >= 0 && dup2(out, 1) >= 0 && dup2(out, 2) >= 0)
            execlp("gnuplot", "gnuplot", "-d", "script", (char *)NULL); // -d: nobody's own settings
    }
    _exit(errno == ENOENT ? 127 : 126);
}

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    char *text = NULL;
    long size = -1;
    if (file && fseek(file, 0, SEEK_END) == 0 && (size = ftell(file)) >= 0 && fseek(file, 0, SEEK_SET) == 0)
        text = malloc((size_t)size + 1);
    if (text) {
        size_t count = fread(text, 1, (size_t)size, file);
        text[count] = '\0';
    }
    if (file)
        fclose(file);
    return text;
}

// A picture of the first line with words in it of what gnuplot said.
static bool write_refusal(const struct figure *figure, int status)
{
    char path[96];
    path_in(figure, "messages", path);
    char *messages = read_file(path), *line = messages ? messages + strspn(messages, " \t\n^") : NULL;
    if (line)
        line[strcspn(line, "\n")] = '\0';
    path_in(figure, "figure.svg", path);
    FILE *svg = fopen(path, "w");
    if (svg) {
        fputs(
            "<svg viewBox=\"0 0 640 48\" xmlns=\"http://www.w3.org/2000/svg\">\n<g font-family=\"sans-serif\" "
            "fill=\"" FIGURE_INK "\"><text x=\"4\" y=\"18\" font-size=\"14\">This figure cannot be drawn from "
            "its numbers.</text>\n<text x=\"4\" y=\"38\" font-size=\"11\">",
            svg);
        html_printf(svg, "gnuplot (status %d): %.90s", status, line && line[0] ? line : "no message");
        fputs("</text></g>\n</svg>\n", svg);
    }
    free(messages);
    return svg && fclose(svg) == 0;
}

static bool run_gnuplot(struct figure *figure, char *error, size_t error_size)
{
    bool written = fflush(figure->script) == 0 && fflush(figure->data) == 0 && !ferror(figure->script) &&
                   !ferror(figure->data);
    if (!written) {
        snprintf(error, error_size, "%s: a figure's data cannot be written: %s", figure->folder,
                 strerror(errno));
        return false;
    }
    fflush(stdout);
    pid_t child = fork();
    if (child < 0) {
        snprintf(error, error_size, "gnuplot cannot be started: %s", strerror(errno));
        return false;
    }
    if (child == 0)
        become_gnuplot(figure->folder);
    int status = 0;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            break;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        snprintf(error, error_size,
                 "gnuplot is not installed, and the figures need it: apt install gnuplot-nox");
    else if (write_refusal(figure, WIFEXITED(status) ? WEXITSTATUS(status) : -1))
        return true;
    else
        snprintf(error, error_size, "%s: a figure cannot be written: %s", figure->folder, strerror(errno));
    return false;
}

bool figure_end(struct figure *figure, const struct figure_text *text, char **out_svg, char *error,
                size_t error_size)
{
    *out_svg = NULL;
    if (run_gnuplot(figure, error, error_size)) {
        char path[96];
        path_in(figure, "figure.svg", path);
        char *svg = read_file(path);
        *out_svg = svg ? figure_embeddable(svg, text) : NULL;
        if (!*out_svg)
            snprintf(error, error_size, "gnuplot wrote no SVG that can be used");
        free(svg);
    }
    figure_abandon(figure);
    return *out_svg != NULL;
}

double figure_tic_step(double range, int most_tics)
{
    double power = pow(10, floor(log10(range / most_tics)));
    const double factors[] = {1, 2, 5, 10};
    int i = 0;
    while (i < 3 && factors[i] * power * most_tics < range)
        i++;
    return factors[i] * power;
}
