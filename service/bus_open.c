#include "bus.h"

#include <stdio.h>
#include <string.h>

lcm_t *bus_open(const char *program, const char *url, long *receive_buffer)
{
    char why[BUS_WHY_MAX], *rest;
    lcm_t *lcm = bus_open_or_why(url, receive_buffer, why);
    if (!lcm)
        for (char *line = strtok_r(why, "\n", &rest); line; line = strtok_r(NULL, "\n", &rest))
            fprintf(stderr, "%s: %s\n", program, line);
    return lcm;
}
