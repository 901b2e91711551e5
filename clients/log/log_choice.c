#include "log_choice.h"

#include "allocate.h"

#include <math.h>
#include <regex.h>
#include <stdlib.h>
#include <string.h>

struct log_channel_choice {
    char *text; /* owned */
    size_t length;
    regex_t regex;
};

struct log_choice log_choice_all(void)
{
    return (struct log_choice){.from = -INFINITY, .to = INFINITY};
}

void log_choice_clear(struct log_choice *choice)
{
    for (size_t i = 0; i < choice->channel_count; i++) {
        regfree(&choice->channel[i].regex);
        free(choice->channel[i].text);
    }
    free(choice->channel);
    *choice = log_choice_all();
}

bool log_choice_add_channel(struct log_choice *choice, const char *text,
                            char why[LOG_CHOICE_WHY_MAX])
{
    struct log_channel_choice channel = {.length = strlen(text)};
    const int error = regcomp(&channel.regex, text, REG_EXTENDED);
    if (error) {
        regerror(error, &channel.regex, why, LOG_CHOICE_WHY_MAX);
        return false;
    }
    channel.text = allocate(channel.length + 1, 1);
    memcpy(channel.text, text, channel.length);
    choice->channel = allocate_grow(choice->channel, &choice->channel_capacity,
                                    choice->channel_count + 1, sizeof *choice->channel);
    choice->channel[choice->channel_count++] = channel;
    return true;
}

bool log_choice_is_all(const struct log_choice *choice)
{
    return choice->from == -INFINITY && choice->to == INFINITY && choice->channel_count == 0;
}

bool log_choice_has_time(const struct log_choice *choice, int64_t first_utime, int64_t utime)
{
    const double seconds = ((double) utime - (double) first_utime) / 1e6;
    return seconds >= choice->from && seconds < choice->to;
}

/* POSIX takes the longest of the leftmost matches, so a match of the whole name is found if there
 * is one. Names that contain a 0, which LCM does not send, match nothing. */
static bool matches(const struct log_channel_choice *channel, const struct log_event *event)
{
    regmatch_t match;
    if (channel->length == event->channel_length &&
        memcmp(channel->text, event->channel, channel->length) == 0)
        return true;
    return strlen(event->channel) == event->channel_length &&
           regexec(&channel->regex, event->channel, 1, &match, 0) == 0 && match.rm_so == 0 &&
           (size_t) match.rm_eo == event->channel_length;
}

bool log_choice_has_channel(const struct log_choice *choice, const struct log_event *event)
{
    for (size_t i = 0; i < choice->channel_count; i++)
        if (matches(&choice->channel[i], event))
            return true;
    return choice->channel_count == 0;
}
