/* What a client is made of. */
#ifndef CLIENT_H
#define CLIENT_H

#include "asking.h"
#include "bus.h"
#include "fmb_client.h"
#include "keys.h"

/* What can be subscribed to. */
enum client_intake { CLIENT_PAIRS, CLIENT_SCENES, CLIENT_STATUSES, CLIENT_INTAKES };

struct fmb_client {
    lcm_t *lcm;
    bool owned;  /* the bus */
    bool failed; /* the bus did */
    bool inside; /* callbacks may be running */
    char prefix[BUS_PREFIX_MAX + 1];
    char query_channel[CLIENT_STATUSES][BUS_CHANNEL_MAX]; /* of pairs and scenes */
    lcm_subscription_t *intake[CLIENT_INTAKES];           /* NULL: not subscribed to so far */
    int64_t client_id, timeout_ns;
    int tries;
    struct fmb_client_watcher watcher;
    struct fmb_client_counts counts;
    struct fmb_client_answer answer; /* of the last pair; with its texts */
    char text[QUERY_TEXT_MAX], certificate[QUERY_CERTIFICATE_MAX];
    char why[FMB_CLIENT_WHY_MAX];
    struct keys keys;
    struct asking asking;
    struct scene_query query;   /* that is being written */
    struct scene_result result; /* that is being read */
};

/* False: the bus refuses. */
bool client_subscribe(struct fmb_client *client, enum client_intake intake);

/* Waits for a message, up to so many milliseconds (negative: without end), then takes those that
 * are there, but no more than some at a time, and none after *enough (may be NULL). Returns how
 * many; sets failed. */
int client_listen(struct fmb_client *client, int wait_ms, const bool *enough);

#endif
