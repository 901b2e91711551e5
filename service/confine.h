/* Drops the privileges that the process does not need once its bus is open. */
#ifndef CONFINE_H
#define CONFINE_H

#include <stdbool.h>

/* Changes to another user. On input: a name; NULL: the user "nobody" if the process runs as root,
 * otherwise no change. Returns true, with a warning on stderr if the user's id does not exist in
 * this user namespace; false: the reason is on stderr. */
bool confine_user(const char *user);

/* Forbids new privileges, and all system calls except those that answering needs: they fail with
 * EPERM. If the kernel accepts no filter, prints a warning on stderr, and all calls stay allowed.
 */
void confine_calls(void);

#endif
