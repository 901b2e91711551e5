#include "complain.h"
#include "output.h"

#include <errno.h>
#include <string.h>

static bool failed(const char *name)
{
    complain("%s: %s", name, strerror(errno));
    return false;
}

FILE *output_open(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        failed(path);
    return file;
}

bool output_close(FILE *file, const char *path)
{
    const bool good = !ferror(file);
    return (fclose(file) == 0 && good) || failed(path);
}

bool output_flush(void)
{
    return (fflush(stdout) == 0 && !ferror(stdout)) || failed("standard output");
}
