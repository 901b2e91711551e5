/* The report of a replay as one line of JSON:
 *
 *     {"differences": [{"log": "a.log", "event": 17, "utime": ..., "time": 1.25,
 *                       "channel": "FMB_PAIR_QUERY", "client_id": 7, "sequence_number": 3,
 *                       "a": 3, "b": 7, "kind": "verdict",
 *                       "then": {"verdict": "touching"}, "now": {"verdict": "separated"}}],
 *      "not_listed": 0, "same": 12, "different": 1, ...}
 *
 * not_listed: number of differences beyond the limit. */
#ifndef REPLAY_JSON_H
#define REPLAY_JSON_H

#include "json_write.h"
#include "replay.h"

struct replay_json {
    struct json_writer json;
};

struct replay_json replay_json_begin(FILE *out);
void replay_json_found(struct replay_json *json, const struct found *found, const char *log,
                       int64_t first_utime);
void replay_json_end(struct replay_json *json, const struct tally *tally, int64_t not_listed,
                     int exit_code);

#endif
