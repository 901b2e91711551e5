#include "url.h"

#include <arpa/inet.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char scheme[] = "udpm://";

/* LCM's default group and port. */
#define DEFAULT_GROUP "239.255.76.67"
enum { DEFAULT_PORT = 7667 };

enum {
    /* Holds about 120 of the largest datagrams, or thousands of pair queries. */
    DEFAULT_RECEIVE_BUFFER = 4 << 20,
    RECEIVE_BUFFER_MAX = INT_MAX / 2, /* the kernel doubles it */
    SHOWN_MAX = 200                   /* most bytes of a URL that an error text repeats */
};

/* A part of the URL: characters at..at + length - 1, without a final 0. */
struct url_part {
    const char *at;
    size_t length;
};

static struct url_part part_until(const char *at, const char *ends)
{
    return (struct url_part){at, strcspn(at, ends)};
}

static bool part_is(struct url_part text, const char *word)
{
    return text.length == strlen(word) && memcmp(text.at, word, text.length) == 0;
}

/* Number of characters of the text that an error text repeats. */
static int shown(struct url_part text)
{
    return text.length < SHOWN_MAX ? (int) text.length : SHOWN_MAX;
}

/* Parses an integer from min to max. Options have base 0, since liblcm accepts 0x10 and 010 there.
 */
static bool parse_number(struct url_part text, int base, int min, int max, int *out)
{
    char digits[16], *end;
    if (!text.length || text.length >= sizeof digits || text.at[0] < '0' || text.at[0] > '9')
        return false;
    memcpy(digits, text.at, text.length);
    digits[text.length] = '\0';
    errno = 0;
    const long value = strtol(digits, &end, base);
    if (errno || *end || value < min || value > max)
        return false;
    *out = (int) value;
    return true;
}

static bool parse_group(struct url_part text, struct in_addr *out)
{
    char address[INET_ADDRSTRLEN];
    if (text.length >= sizeof address)
        return false;
    memcpy(address, text.at, text.length);
    address[text.length] = '\0';
    return inet_pton(AF_INET, address, out) == 1 && IN_MULTICAST(ntohl(out->s_addr));
}

/* GROUP:PORT */
static bool parse_address(struct url_part text, struct sockaddr_in *out, char why[BUS_WHY_MAX])
{
    const char *colon = memchr(text.at, ':', text.length);
    const size_t length = colon ? (size_t) (colon - text.at) : text.length;
    const struct url_part group = {text.at, length};
    int port;
    if (!parse_group(group, &out->sin_addr)) {
        snprintf(
            why, BUS_WHY_MAX,
            "'%.*s' is not a multicast group (224.0.0.0 to 239.255.255.255), and LCM sends to no "
            "single host: write %s%s:%d, with ?ttl=1 after it to reach other hosts",
            shown(group), group.at, scheme, DEFAULT_GROUP, DEFAULT_PORT);
        return false;
    }
    if (!colon) {
        snprintf(why, BUS_WHY_MAX, "the LCM bus %.*s has no port: write %s%.*s:%d", shown(group),
                 group.at, scheme, shown(group), group.at, DEFAULT_PORT);
        return false;
    }
    const struct url_part number = {colon + 1, text.length - length - 1};
    if (!parse_number(number, 10, 1, 65535, &port)) {
        snprintf(why, BUS_WHY_MAX, "'%.*s' is not a port of an LCM bus: write 1 to 65535",
                 shown(number), number.at);
        return false;
    }
    out->sin_port = htons((uint16_t) port);
    return true;
}

/* NAME=VALUE */
static bool parse_option(struct url_part option, struct bus_url *out, char why[BUS_WHY_MAX])
{
    const char *equals = memchr(option.at, '=', option.length);
    const size_t length = equals ? (size_t) (equals - option.at) : option.length;
    const struct url_part name = {option.at, length};
    const struct url_part value = {option.at + length + !!equals,
                                   option.length - length - !!equals};
    if (part_is(name, "ttl")) {
        if (parse_number(value, 0, 0, 255, &out->ttl))
            return true;
        snprintf(why, BUS_WHY_MAX, "'%.*s' is not a ttl of an LCM bus: write ttl=0 to ttl=255",
                 shown(value), value.at);
    } else if (part_is(name, "recv_buf_size")) {
        if (parse_number(value, 0, 1, RECEIVE_BUFFER_MAX, &out->receive_buffer))
            return true;
        snprintf(why, BUS_WHY_MAX,
                 "'%.*s' is not a recv_buf_size of an LCM bus: write a number of bytes, 1 to %d",
                 shown(value), value.at, RECEIVE_BUFFER_MAX);
    } else {
        snprintf(why, BUS_WHY_MAX,
                 "unknown option '%.*s' of an LCM bus: there are ttl=N and recv_buf_size=N",
                 shown(option), option.at);
    }
    return false;
}

static bool parse_options(const char *at, struct bus_url *out, char why[BUS_WHY_MAX])
{
    for (;;) {
        const struct url_part option = part_until(at, "&");
        if (!parse_option(option, out, why))
            return false;
        if (!option.at[option.length])
            return true;
        at = option.at + option.length + 1;
    }
}

static bool refuse_scheme(const char *url, char why[BUS_WHY_MAX])
{
    const struct url_part whole = part_until(url, "");
    snprintf(why, BUS_WHY_MAX,
             "'%.*s' is not an LCM bus over UDP multicast, the only kind that is supported: write "
             "%s%s:%d?ttl=0",
             shown(whole), url, scheme, DEFAULT_GROUP, DEFAULT_PORT);
    return false;
}

bool bus_url_parse(const char *url, struct bus_url *out, char why[BUS_WHY_MAX])
{
    *out = (struct bus_url){.group = {.sin_family = AF_INET, .sin_port = htons(DEFAULT_PORT)},
                            .receive_buffer = DEFAULT_RECEIVE_BUFFER};
    inet_pton(AF_INET, DEFAULT_GROUP, &out->group.sin_addr);
    if (strncmp(url, scheme, sizeof scheme - 1) != 0)
        return refuse_scheme(url, why);
    const struct url_part address = part_until(url + sizeof scheme - 1, "?");
    if (address.length && !parse_address(address, &out->group, why))
        return false;
    const char *options = address.at + address.length;
    return !options[0] || !options[1] || parse_options(options + 1, out, why);
}
