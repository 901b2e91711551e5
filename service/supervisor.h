/* Watches over a worker process, and puts another in the place of one that died.
 *
 * LCM's receiving thread can be crashed by malformed packets, in any program that has one. So the
 * bus is opened by a worker, and the process that people and service managers know holds no bus:
 * it waits for signals, and for nothing else.
 *
 * Whichever way a worker ends that was not told to by the supervisor, it is replaced: at once if it
 * had been ready, and then without limit, since packets may come for ever; after a pause that
 * grows if it had not, and then not for ever (the numbers are in supervisor.c). So is one that
 * somebody else sent a SIGTERM: the service is ended by ending the supervisor. A worker does not
 * outlive its supervisor. */
#ifndef SUPERVISOR_H
#define SUPERVISOR_H

#include <stdint.h>

/* Runs in the worker's process, and returns its exit code. On input: options as they were given;
 * restarts: how many workers there were before this one; ready: a descriptor to which 8 bytes,
 * the uint64_t 1, are to be written as soon as the worker serves. SIGINT and SIGTERM are not
 * blocked, and SIGTERM ends the process: the supervisor sends it, whichever came to itself. */
typedef int supervisor_job(const void *options, int64_t restarts, int ready);

/* To be called before any thread is started and any bus opened.
 *
 * On output, in the supervisor: the code to exit with. 0 after SIGINT or SIGTERM: the worker has
 * ended, or has been killed since it did not. If it was ready, and ended itself with another
 * code, that one. If the first worker ended by itself before it was ready, its code, and
 * nothing is said: the worker has said why. EXIT_FAILURE after a line on stderr: too many
 * workers in a row died before they were ready. Does not return in a worker. */
int supervisor_run(supervisor_job *job, const void *options);

#endif
