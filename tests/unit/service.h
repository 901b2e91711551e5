/* A server without a bus, and all that it published. One at a time. */
#ifndef SERVICE_H
#define SERVICE_H

#include "server.h"
#include "wire.h"

enum { SERVICE_RESULTS_MAX = 40000, SERVICE_CLIENTS = 100 };

struct service_result {
    enum server_kind kind;
    int64_t client_id, sequence_number;
    int32_t status, end_pair;
    int64_t published_ns;
};

extern struct service {
    struct server *server;
    int count;
    struct service_result result[SERVICE_RESULTS_MAX];
    int64_t answers[SERVICE_CLIENTS]; /* [client_id] number of results */
    struct pair_result pair; /* the last one; its certificate is a copy, "" where it has none */
    char certificate[FMB_CERTIFICATE_MAX];
    int64_t scene_compute_ns;  /* of the last scene */
    int32_t definition_bodies; /* of the last definition */
    struct wire_status status; /* the last heartbeat */
    /* The clock advances by tick_ns at each reading, and by the cost of a result while that is
     * published: refusal_ns for FMB_BUSY; for others odd_cost_ns[client_id], if not 0 and the
     * sequence number is odd; otherwise cost_ns[client_id]. */
    int64_t now_ns, tick_ns, refusal_ns, cost_ns[SERVICE_CLIENTS], odd_cost_ns[SERVICE_CLIENTS];
    int64_t batch_ns;  /* time to read a batch */
    int64_t opened_ns; /* clock_ns() before the server was created */
    bool refuses;      /* the bus does */
} service;

int service_open(void **state);
int service_close(void **state);

/* One message, as a batch of its own. */
void service_receive(enum server_kind kind, const unsigned char *bytes, size_t size);

/* Works until nothing waits. */
void service_settle(void);

const struct wire_status *service_status(void);

/* ---- Queries ---- */

/* Two squares side by side. */
struct pair_query service_pair(int64_t client_id, int64_t sequence_number);
void service_send_pair(const struct pair_query *query);
void service_query_pair(int64_t client_id, int64_t sequence_number);

/* Two gratings of so many frames each, up to 900, all of which overlap: as a pair, and as a scene
 * of one pair with its contact interval. */
void service_query_frames(int64_t client_id, int64_t sequence_number, int frames);
void service_query_frames_scene(int64_t client_id, int64_t sequence_number, int frames);

/* All pairs of slanting strips, all whose boxes overlap. */
void service_query_scene(int64_t client_id, int64_t sequence_number, int32_t bodies);

void service_query_definitions(int64_t client_id, int64_t sequence_number);

#endif
