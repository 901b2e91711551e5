#include "log_choice.h"

#include "allocate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct log_choice log_choice_all(void)
{
    return (struct log_choice){.from = -INFINITY, .to = INFINITY};
}

void log_choice_clear(struct log_choice *choice)
{
    if (choice->has_channel)
        regfree(&choice->channel);
    *choice = log_choice_all();
}

bool log_choice_take_channel(const struct args *args, void *out)
{
    struct log_choice *choice = out;
    char why[128];
    if (choice->has_channel)
        return args_error(args, "--channel is given twice: combine the expressions by '|'");
    char *whole = allocate(strlen(optarg) + sizeof "^()$", 1);
    sprintf(whole, "^(%s)$", optarg);
    const int error = regcomp(&choice->channel, whole, REG_EXTENDED | REG_NOSUB);
    free(whole);
    choice->has_channel = error == 0;
    if (error == 0)
        return true;
    regerror(error, &choice->channel, why, sizeof why);
    return args_error(args, "--channel: '%s' is no regular expression: %s", optarg, why);
}

bool log_choice_is_all(const struct log_choice *choice)
{
    return choice->from == -INFINITY && choice->to == INFINITY && !choice->has_channel;
}

bool log_choice_has_time(const struct log_choice *choice, int64_t first_utime, int64_t utime)
{
    const double seconds = ((double) utime - (double) first_utime) / 1e6;
    return seconds >= choice->from && seconds < choice->to;
}

bool log_choice_has_channel(const struct log_choice *choice, const char *channel)
{
    return !choice->has_channel || regexec(&choice->channel, channel, 0, NULL, 0) == 0;
}
