/* Gives a target the files that are named, and those in the folders that are named; without any,
 * those of its corpus. Writes TAP, of one test. */
#include "fuzz.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_BYTES = 4096 };

static size_t replayed;

static _Noreturn void give_up(const char *path)
{
    perror(path);
    exit(1);
}

static uint8_t *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file || fseek(file, 0, SEEK_END) != 0)
        give_up(path);
    const long end = ftell(file);
    *size = end > 0 ? (size_t) end : 0;
    uint8_t *bytes = fuzz_room(*size);
    rewind(file);
    if (end < 0 || fread(bytes, 1, *size, file) != *size)
        give_up(path);
    fclose(file);
    return bytes;
}

/* Named first: what is wrong may end the process. */
static void replay_file(const char *path)
{
    size_t size;
    uint8_t *bytes = read_file(path, &size);
    fprintf(stderr, "%s\n", path);
    LLVMFuzzerTestOneInput(bytes, size);
    free(bytes);
    replayed++;
}

static void replay(const char *path);

static void replay_folder(const char *path)
{
    DIR *folder = opendir(path);
    if (!folder)
        give_up(path);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char inside[PATH_BYTES];
        snprintf(inside, sizeof inside, "%s/%s", path, entry->d_name);
        if (entry->d_name[0] != '.')
            replay(inside);
    }
    closedir(folder);
}

static void replay(const char *path)
{
    struct stat about;
    if (stat(path, &about) != 0)
        give_up(path);
    if (S_ISDIR(about.st_mode))
        replay_folder(path);
    else
        replay_file(path);
}

int main(int argc, char **argv)
{
    const char *name = strstr(argv[0], "fuzz_"); /* build/tests/test_fuzz_TARGET */
    char corpus[PATH_BYTES];
    name = name ? name + strlen("fuzz_") : argv[0];
    snprintf(corpus, sizeof corpus, "tests/fuzz/corpus/%s", name);
    printf("1..1\n");
    fflush(stdout);
    for (int i = 1; i < argc; i++)
        replay(argv[i]);
    if (argc == 1)
        replay(corpus);
    printf("%sok 1 - %s: %zu inputs\n", replayed ? "" : "not ", name, replayed);
    return replayed ? 0 : 1;
}
