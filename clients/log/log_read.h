/* Reads LCM event logs, which may be damaged or hostile.
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
 * An event is accepted if its lengths stay within the file and it is followed by another event or
 * the end of the file. It is also accepted if no other event begins inside it: the bytes after it
 * are then the damage. Bytes between accepted events are damage, and reported with their offset. So
 * each byte of a file is in exactly one event or damage, and data inside an accepted event, even a
 * whole log, is not read as events. If another program changes the file meanwhile, events may have
 * any contents, but their lengths are within these limits.
 *
 * Uses one buffer of fixed size, whatever the size of the file and of its events, and time linear
 * in the size of the file. Does not decode messages. */
#ifndef LOG_READ_H
#define LOG_READ_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Most bytes kept of the data of an event: more than a message of one datagram has. */
enum { LOG_DATA_MAX = 65536 };

/* Most bytes of a channel name, final 0 included; longer ones are damage. LCM publishes names of at
 * most 63 characters; its log reader accepts up to 999. */
enum { LOG_CHANNEL_MAX = 1000 };

enum { LOG_HEADER_BYTES = 28 };

struct log_event {
    int64_t offset;      /* of the header, bytes from the beginning of the file */
    int64_t length;      /* of header, name and data, bytes */
    int64_t number;      /* as in the header; most logs count events from 0 */
    int64_t utime;       /* as in the header: time of logging, microseconds since 1970 */
    const char *channel; /* any bytes, even 0; followed by a 0 */
    size_t channel_length;
    const unsigned char *data; /* the first kept bytes of size */
    size_t size, kept;
};

struct log_damage {
    int64_t offset, length; /* bytes */
    const char *what;       /* static, for people: "the last event is cut off" */
};

struct log_reader;

/* Bytes of an error text, final 0 included. */
enum { LOG_WHY_MAX = 256 };

/* Opens a log, at its beginning. The caller closes it. Returns NULL and why if it cannot be opened,
 * is not a regular file, or memory is exhausted. An empty file is a log without events. */
struct log_reader *log_open(const char *path, char why[LOG_WHY_MAX]);
void log_close(struct log_reader *reader); /* may be NULL */

/* Size of the file when it was opened, bytes; data appended later are not read. */
int64_t log_size(const struct log_reader *reader);

/* To be called before the first event: reads as if the file had this size, if it is larger. A
 * smaller one fails, as if it was truncated. */
void log_limit(struct log_reader *reader, int64_t size);

/* FAILED: the file cannot be read: errno (ENODATA: it was truncated). All later calls fail too. */
enum log_outcome { LOG_EVENT, LOG_DAMAGE, LOG_END, LOG_FAILED };

/* On output: EVENT: *event, with pointers valid until the next call; DAMAGE: *damage. */
enum log_outcome log_next(struct log_reader *reader, struct log_event *event,
                          struct log_damage *damage);

/* Continues at an offset, from 0 to the size: that of an event that was read; or any other, and
 * then with the first accepted event from there on, without reporting the bytes before it. At 0,
 * damage is reported again. */
void log_seek(struct log_reader *reader, int64_t offset);

/* Reads all data of an event, including the bytes that were not kept. Returns false on error:
 * errno. After an error, all later calls and log_next() fail too. */
bool log_read_data(struct log_reader *reader, const struct log_event *event, unsigned char *out);

#endif
