/* The state of a client, private to the library. Not thread-safe (fmb_client.h). */
#ifndef CLIENT_H
#define CLIENT_H

#include "bus.h"
#include "fmb_client.h"
#include "held.h"
#include "scene_run.h"
#include "wire.h"

/* Channels that can be received: results of each kind, and the heartbeat. */
enum { CLIENT_STATUS = FMB_CLIENT_KINDS, CLIENT_CHANNELS };

struct fmb_client {
    struct bus *bus;
    bool failed; /* the bus has failed */
    bool inside; /* a call that may run callbacks is under way */
    char prefix[BUS_PREFIX_MAX + 1];
    char query_channel[FMB_CLIENT_KINDS][BUS_CHANNEL_MAX];
    int listener_count;
    int channel[CLIENT_CHANNELS]; /* [number of the bus_listen() call]: CLIENT_STATUS or a kind */
    bus_handler *tap;             /* fmb_client_raw_listen(); NULL: none */
    void *tap_user;
    struct fmb_client_watcher watcher;
    struct held held;
    struct requests requests;
    struct scene_run run;
    struct fmb_client_answer answer; /* of the last single pair, with its texts */
    char text[QUERY_TEXT_MAX], certificate[FMB_CERTIFICATE_MAX];
    char why[FMB_CLIENT_WHY_MAX];
    union { /* the message being decoded */
        struct result_head head;
        struct pair_result pair;
        struct scene_result scene;
        struct definition definition;
    } received;
};

#endif
