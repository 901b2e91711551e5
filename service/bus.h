/* Opening the LCM bus, and saying what to do where it cannot be opened. */
#ifndef BUS_H
#define BUS_H

#include <lcm/lcm.h>
#include <stdbool.h>

enum { BUS_CHANNEL_MAX = 64 }; /* LCM's limit, with the final 0 */

/* Channel names: prefix then name. A prefix has at most BUS_PREFIX_MAX letters, digits, '_'
 * or '-', so that it means itself in LCM's regular expressions. */
enum { BUS_PREFIX_MAX = 32 };
bool bus_prefix_ok(const char *prefix);
void bus_channel(char out[BUS_CHANNEL_MAX], const char *prefix, const char *name);

/* Room for why a bus cannot be opened: one or two lines without the last end of line. */
enum { BUS_WHY_MAX = 512 };

/* On input: url, or NULL for LCM_DEFAULT_URL or, without that, the usual multicast group on
 * this host alone (ttl=0) with as large a receive buffer as the system grants.
 * On output: the bus, to be destroyed by the caller with lcm_destroy(); or NULL, and why says what
 * is wrong and what to run. Where the multicast group has no route, LCM's own lines on stderr are
 * not provoked.
 * *receive_buffer (may be NULL): bytes that the system grants the socket; 0: not known. */
lcm_t *bus_open_or_why(const char *url, long *receive_buffer, char why[BUS_WHY_MAX]);

/* The same for a program, which says why on stderr, in lines that begin with its name. */
lcm_t *bus_open(const char *program, const char *url, long *receive_buffer);

/* Subscribes, with room for this many messages to wait; beyond it LCM drops the newest without a
 * word. On output: the subscription, or NULL where LCM refuses. */
lcm_subscription_t *bus_subscribe(lcm_t *lcm, const char *channel, lcm_msg_handler_t handler,
                                  void *user, int queue);

#endif
