/* Reads LCM's event logs, and believes nothing that they say of themselves.
 *
 * A log is a file of events, one after the other, each a header of 28 bytes, big-endian,
 *
 *     uint32  0xEDA1DA01
 *     int64   number of the event
 *     int64   time of the log, microseconds since 1970
 *     int32   length of the channel's name, 1 or more
 *     int32   size of the data, 0 or more
 *
 * then the name without a final 0, then the data: what was published. There is no index, no
 * checksum, and nothing at the beginning or the end of the file.
 *
 * An event is believed where its lengths stay within the file and the next event, or the end of the
 * file, stands just behind it; or where at least no other event begins inside of it: then what
 * stands behind it is the damage. What lies between two events that are believed is damage, and
 * told with its place. So no byte of a file is neither in an event nor in a damage, and what was
 * written into an event that is believed, whole logs too, is not taken for one.
 *
 * Reads on and on in one buffer of fixed size, whatever the size of the file and of its events, in
 * a time that grows as the size of the file. Knows nothing of what messages say. */
#ifndef LOG_READ_H
#define LOG_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Of the data of an event the first so many bytes are kept, more than any message has that goes in
 * one datagram. */
enum { LOG_DATA_MAX = 65536 };

/* Of a channel's name, with the final 0 that is added here: longer ones are damage. LCM's own have
 * at most 63 characters; LCM's reader takes up to 999. */
enum { LOG_CHANNEL_MAX = 1000 };

enum { LOG_HEADER_BYTES = 28 };

struct log_event {
    int64_t offset;      /* of the header, bytes from the beginning of the file */
    int64_t length;      /* of all of it, header, name and data, bytes */
    int64_t number;      /* as it says; most logs count from 0 */
    int64_t utime;       /* as it says: when it was logged, microseconds since 1970 */
    const char *channel; /* any bytes, 0 too; ended by a 0 that is not among them */
    size_t channel_length;
    const unsigned char *data; /* the first kept bytes of size */
    size_t size, kept;
};

struct log_damage {
    int64_t offset, length; /* bytes */
    const char *what;       /* static, for people: "the last event is cut off" */
};

struct log_reader;

/* Room for why a log cannot be opened. */
enum { LOG_WHY_MAX = 256 };

/* On output: a reader at the beginning, to be closed by the caller; or NULL, and why: it cannot be
 * opened, is no regular file, no memory. An empty file is a log of no events. */
struct log_reader *log_open(const char *path, char why[LOG_WHY_MAX]);
void log_close(struct log_reader *reader); /* may be NULL */

/* Size of the file when it was opened; what was written since is not read. */
int64_t log_size(const struct log_reader *reader);

/* FAILED: the file cannot be read, errno says why (ENODATA: it has become shorter); there will be
 * nothing more. */
enum log_outcome { LOG_EVENT, LOG_DAMAGE, LOG_END, LOG_FAILED };

/* On output: EVENT: *event, whose pointers are good until the next call; DAMAGE: *damage. */
enum log_outcome log_next(struct log_reader *reader, struct log_event *event,
                          struct log_damage *damage);

/* Goes on at an event: on input the offset of one that was read; or from anywhere, with the first
 * event at or behind the offset that is believed, and what lies before it is not told. From 0 to
 * the size. */
void log_seek(struct log_reader *reader, int64_t offset);

/* Begins anew: damage with which the file begins is told too. */
void log_rewind(struct log_reader *reader);

/* All data of an event that was read, also those beyond what is kept: the file itself, mapped, to
 * be given back with log_unmap(). No memory is asked for, whatever the size. NULL: errno (ENODATA:
 * the file has become shorter). */
const void *log_map(const struct log_reader *reader, const struct log_event *event);
void log_unmap(const void *data, const struct log_event *event);

#endif
