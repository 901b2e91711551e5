#define _GNU_SOURCE
#include "machine.h"

#include <sched.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

const char *machine_cpu(char text[MACHINE_TEXT_MAX])
{
    char line[MACHINE_TEXT_MAX] = "";
    FILE *info = fopen("/proc/cpuinfo", "r");
    strcpy(text, "unknown");
    while (info && fgets(line, sizeof line, info)) {
        const char *colon = strchr(line, ':');
        if (strncmp(line, "model name", 10) != 0 || !colon)
            continue;
        strcpy(text, colon + 1 + strspn(colon + 1, " "));
        text[strcspn(text, "\n")] = '\0';
        break;
    }
    if (info)
        fclose(info);
    return text;
}

const char *machine_compiler(void)
{
#ifdef __clang__
    return __VERSION__;
#else
    return "gcc " __VERSION__;
#endif
}

int machine_cores(void)
{
    return (int) sysconf(_SC_NPROCESSORS_ONLN);
}

/* /sys lists them from the first level on, the last one last: "32768K". */
size_t machine_last_cache(void)
{
    size_t last = 0;
    for (int index = 0;; index++) {
        char path[96];
        unsigned long size;
        char unit = ' ';
        snprintf(path, sizeof path, "/sys/devices/system/cpu/cpu0/cache/index%d/size", index);
        FILE *file = fopen(path, "r");
        if (!file)
            return last;
        if (fscanf(file, "%lu%c", &size, &unit) >= 1)
            last = size << (unit == 'K' ? 10 : unit == 'M' ? 20 : 0);
        fclose(file);
    }
}
