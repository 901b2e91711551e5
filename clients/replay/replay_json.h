/* What a replay found, as one line of JSON:
 *
 *     {"differences": [{"log": "a.log", "event": 17, "utime": ..., "time": 1.25,
 *                       "channel": "FMB_PAIR_QUERY", "client_id": 7, "sequence_number": 3,
 *                       "a": 3, "b": 7, "kind": "verdict",
 *                       "then": {"verdict": "touching"}, "now": {"verdict": "separated"}}],
 *      "untold": 0, "same": 12, "different": 1, ...}
 *
 * untold: differences beyond the limit of those listed. */
#ifndef REPLAY_JSON_H
#define REPLAY_JSON_H

#include "replay.h"

struct replay_json {
    FILE *out;
    bool first; /* no difference was written yet */
};

struct replay_json replay_json_begin(FILE *out);
void replay_json_found(struct replay_json *json, const struct found *found, const char *log,
                       int64_t first_utime);
void replay_json_end(struct replay_json *json, const struct tally *tally, int64_t untold,
                     int exit_code);

#endif
