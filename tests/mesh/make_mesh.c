/* make-mesh [--format FORMAT] [--faces N] [--seed SEED] [FILE]: writes a closed mesh with bumps
 * (bumpy.h), to standard output without a FILE. The same options give the same bytes on every
 * machine. */
#include "bumpy.h"
#include "formats.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: make-mesh [--format FORMAT] [--faces N] [--seed SEED] [FILE]\n"
    "\n"
    "Writes a closed mesh of triangles, a sphere with bumps, to FILE or standard output.\n"
    "\n"
    "  --format FORMAT  ply-ascii (default), ply-le, ply-be, stl-ascii, stl-binary, obj,\n"
    "                   dae\n"
    "  --faces N        about so many triangles, 8 n^2 in fact (default 70000)\n"
    "  --seed SEED      which bumps (default 1)\n"
    "  --help           prints this\n";

/* ---- Options --------------------------------------------------------------------------------- */

struct options {
    const struct format *format;
    unsigned long faces, seed;
    const char *file; /* NULL: standard output */
};

static _Noreturn void refuse(const char *what)
{
    fprintf(stderr, "make-mesh: %s\n%s", what, usage);
    exit(2);
}

static const struct format *format_of(const char *name)
{
    for (size_t i = 0; i < FORMAT_COUNT; i++)
        if (strcmp(formats[i].name, name) == 0)
            return &formats[i];
    refuse("no such format");
}

static unsigned long number_of(const char *text, unsigned long least, unsigned long most)
{
    char *end;
    errno = 0;
    const unsigned long value = strtoul(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || errno || value < least || value > most)
        refuse("a number is out of range, or none");
    return value;
}

static void read_option(const char *name, const char *value, struct options *options)
{
    if (!value)
        refuse("an option has no value");
    if (strcmp(name, "--format") == 0)
        options->format = format_of(value);
    else if (strcmp(name, "--faces") == 0)
        options->faces = number_of(value, BUMPY_FACES_MIN, BUMPY_FACES_MAX);
    else if (strcmp(name, "--seed") == 0)
        options->seed = number_of(value, 0, UINT32_MAX);
    else
        refuse("no such option");
}

static void read_options(char **argument, struct options *options)
{
    for (; *argument; argument++) {
        if (strcmp(*argument, "--help") == 0) {
            fputs(usage, stdout);
            exit(0);
        }
        if (**argument == '-') {
            read_option(argument[0], argument[1], options);
            argument++;
        } else if (options->file) {
            refuse("more than one file");
        } else {
            options->file = *argument;
        }
    }
}

int main(int argc, char **argv)
{
    struct options options = {.format = &formats[0], .faces = 70000, .seed = 1};
    struct mesh mesh;
    (void) argc;
    read_options(argv + 1, &options);
    FILE *out = options.file ? fopen(options.file, "wb") : stdout;
    if (!out) {
        perror(options.file);
        return 1;
    }
    bumpy_make((unsigned) options.faces, options.seed, &mesh);
    options.format->write(out, &mesh);
    mesh_free(&mesh);
    if (ferror(out) | (fclose(out) != 0)) {
        perror(options.file ? options.file : "standard output");
        return 1;
    }
    return 0;
}
