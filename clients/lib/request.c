#include "request.h"

#include "big_endian.h"
#include "clock.h"

#include <string.h>

enum {
    /* Pauses before a busy service is queried again: 10, 20, 40, ... 320, 320, ... milliseconds, a
     * minute in all. After them its refusal is the result. */
    BUSY_PAUSE_MS = 10,
    BUSY_DOUBLINGS = 5,
    BUSY_MAX = 200,
    /* Intervals before the first repeat: this margin after the usual response time; and where that
     * is not known yet. Scenes may take long to decide, and a repeated one is decided again. */
    MARGIN_MS = 8,
    FIRST_RETRY_MS = 10,
    FIRST_SCENE_RETRY_MS = 40,
    /* The reordering window. A spurious repeat doubles it and adds the first constant, up to the
     * second. Each result shortens it by 1 / REORDERING_DECAY of it. */
    REORDERING_STEP_US = 100,
    REORDERING_MAX_US = 1000 * MARGIN_MS,
    REORDERING_DECAY = 64,
    /* A default receive buffer has 212,992 bytes, and also holds datagrams of other senders. A
     * datagram takes at most twice its bytes there, plus a constant; the largest take 70,000. */
    CHARGE_MAX = 150000,
    CHARGE_LARGEST = 70000,
    CHARGE_EACH = 1024,
    /* Positions of the ids in a query, bytes: after fingerprint and utime. */
    CLIENT_ID_AT = 16,
    NUMBER_AT = 24
};

static const int64_t ns_per_us = 1000, ns_per_ms = 1000000, ns_per_s = 1000000000;

/* Loss explains a repeat if the losses before it have at least this probability: 21 repeats if half
 * of the queries are lost, 4 if one in fifty is, and 1 if none is. */
static const double loss_chance_min = 1.0 / (1 << 20);
/* A larger share of repeated queries is not explained by loss: the service is slow. */
static const double loss_share_max = 0.5;
/* Weight of a result in the moving averages. */
static const double share_weight = 1.0 / 32;
/* Repeats are useful if the share of spurious ones is less than half of all by this margin. */
static const double spurious_margin = 0.1;

const char *fmb_client_status_text(int status)
{
    switch (status) {
#define X(name, number, text) \
    case number: return text;
        FMB_CLIENT_STATUS_MAP(X)
#undef X
    }
    return fmb_status_text(status);
}

void requests_forget_pace(struct requests *requests)
{
    for (int kind = 0; kind < FMB_CLIENT_KINDS; kind++) {
        const int first = kind == FMB_CLIENT_SCENE ? FIRST_SCENE_RETRY_MS : FIRST_RETRY_MS;
        requests->pace[kind] = (struct request_pace){.retry = first * ns_per_ms};
    }
}

/* ---- The window ---- */

static size_t charge_of(size_t bytes)
{
    const size_t charge = 2 * bytes + CHARGE_EACH;
    return charge < CHARGE_LARGEST ? charge : CHARGE_LARGEST;
}

/* During an outage one request at a time tests whether it has ended. */
bool requests_ready(const struct requests *requests, size_t bytes)
{
    if (requests->count == 0)
        return true;
    return !requests->outage && requests->count < FMB_CLIENT_RAW_WINDOW &&
           requests->charge + charge_of(bytes) <= CHARGE_MAX;
}

void request_end(struct requests *requests, struct request *request)
{
    request->under_way = false;
    requests->count--;
    requests->charge -= request->charge;
}

/* Ends a request without a result. */
static void fail(struct requests *requests, struct request *request, int status)
{
    const struct request_result none = {.kind = request->kind, .status = status, .detail = ""};
    request_end(requests, request);
    request->handler(request->user, request, &none);
}

/* ---- Sending ---- */

struct request *request_begin(struct requests *requests, enum fmb_client_kind kind, size_t bytes,
                              request_handler *handler, void *user)
{
    struct request *request = requests->request;
    if (requests->count == 0)
        requests->transport.receive(requests->transport.user);
    while (request->under_way)
        request++;
    request->under_way = true;
    request->kind = kind;
    request->handler = handler;
    request->user = user;
    request->refusals = 0;
    request->charge = charge_of(bytes);
    requests->count++;
    requests->charge += request->charge;
    return request;
}

static void publish(struct requests *requests, struct request *request)
{
    const struct request_transport *transport = &requests->transport;
    if (!transport->publish(transport->user, request->kind, request->query, request->size))
        requests->counts.unsent++;
    requests->counts.bytes += request->size;
    request->pausing = request->presumed_lost = false;
    request->sent_at = clock_ns();
    request->deadline = request->sent_at + request->interval;
}

/* Returns how long a request waits for its result in all, nanoseconds. */
static int64_t total_timeout(const struct requests *requests)
{
    return requests->outage ? requests->timeout_ns : requests->timeout_ns * requests->tries;
}

void request_send(struct requests *requests, struct request *request)
{
    const int64_t retry = requests->pace[request->kind].retry;
    const size_t charge = charge_of(request->size);
    if (charge > request->charge) { /* a later query of a request may be larger than the first */
        requests->charge += charge - request->charge;
        request->charge = charge;
    }
    request->number = requests->next_number++;
    big_endian_put_64(request->query + CLIENT_ID_AT, (uint64_t) requests->client_id);
    big_endian_put_64(request->query + NUMBER_AT, (uint64_t) request->number);
    request->interval = retry < requests->timeout_ns ? retry : requests->timeout_ns;
    request->repeated = false;
    request->loss_chance = 1;
    requests->counts.queries++;
    publish(requests, request);
    request->first_at = request->pending_at = request->sent_at;
    request->give_up_at = request->sent_at + total_timeout(requests);
}

static bool explained_by_loss(const struct request *request)
{
    return request->loss_chance >= loss_chance_min;
}

/* Whether most repeats are useful. Where most are spurious, because results are reordered, a result
 * may answer any sending of its query. */
static bool repeats_are_useful(const struct request_pace *pace)
{
    return pace->spurious_share + spurious_margin < pace->loss_share / 2;
}

static void repeat(struct requests *requests, struct request *request)
{
    const struct request_pace *pace = &requests->pace[request->kind];
    const bool lost_or_refused = request->presumed_lost || request->pausing;
    if (request->pausing) {
        request->give_up_at = clock_ns() + total_timeout(requests);
    } else {
        if (!explained_by_loss(request))
            request->interval = clock_earlier(2 * request->interval, requests->timeout_ns);
        request->loss_chance *=
            pace->loss_share < loss_share_max ? pace->loss_share : loss_share_max;
    }
    request->repeated = true;
    requests->counts.repeated++;
    publish(requests, request);
    if (lost_or_refused && repeats_are_useful(pace))
        request->pending_at = request->sent_at;
}

/* ---- Results ---- */

/* Any result shows that a service is there, also one of a query that is not under way any more. */
static void note_service(struct requests *requests)
{
    requests->received_at = clock_ns();
    requests->outage = false;
}

/* Only the result of a request under way shows that the service gets on with the others: of these
 * there is a limited number, whereas other results may be forged without end. */
static void note_received(struct requests *requests, enum fmb_client_kind kind)
{
    note_service(requests);
    requests->pace[kind].received_at = requests->received_at;
}

/* Adapts retry to a repeated query, whose response time is unknown. If none was measured since it
 * was first sent, either it was lost or retry is too short. Before the first measurement, retry
 * becomes twice the interval within which the result came. Later it doubles after UNMEASURED_MAX
 * such results in a row: so many losses in a row are rare. */
enum { UNMEASURED_MAX = 4 };

static void adapt_retry(struct request_pace *pace, const struct request *request)
{
    if (request->first_at < pace->measured_at)
        return;
    pace->unmeasured++;
    if (pace->mean == 0 && pace->retry < 2 * request->interval)
        pace->retry = 2 * request->interval;
    else if (pace->mean > 0 && pace->unmeasured % UNMEASURED_MAX == 0 &&
             pace->retry < request->interval * 2)
        pace->retry *= 2;
}

/* Widens the reordering window after a result that no query under way expects: usually the second
 * result of a query that was repeated too early. With two services on the channels the window stays
 * at its limit. The window decays, so about one spurious repeat in a hundred results remains. */
static void adapt_to_spurious_repeat(struct request_pace *pace)
{
    const int64_t wider = 2 * pace->reordering_window + REORDERING_STEP_US * ns_per_us;
    pace->reordering_window = clock_earlier(wider, REORDERING_MAX_US * ns_per_us);
    pace->spurious_share += share_weight * (1 - pace->spurious_share);
}

/* Measures the response time, unless the query was repeated: the result may answer any sending. */
static void measure(struct request_pace *pace, const struct request *request)
{
    const int64_t now = clock_ns();
    const int64_t time = now - request->sent_at;
    if (request->pending_at > pace->newest_answered_at)
        pace->newest_answered_at = request->pending_at;
    pace->loss_share += share_weight * ((request->loss_chance < 1) - pace->loss_share);
    pace->spurious_share -= share_weight * pace->spurious_share;
    pace->reordering_window -= pace->reordering_window / REORDERING_DECAY;
    if (request->repeated) {
        adapt_retry(pace, request);
        return;
    }
    pace->measured_at = now;
    pace->unmeasured = 0;
    if (pace->mean == 0) {
        pace->mean = time;
        pace->deviation = time / 2;
    } else {
        const int64_t difference = time - pace->mean;
        pace->deviation += ((difference < 0 ? -difference : difference) - pace->deviation) / 4;
        pace->mean += difference / 8;
    }
    pace->retry = pace->mean + 4 * pace->deviation + MARGIN_MS * ns_per_ms;
}

/* Returns the request under way that the result belongs to; NULL: none. */
static struct request *find(struct requests *requests, const struct request_result *result)
{
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++) {
        struct request *request = &requests->request[i];
        if (request->under_way && request->kind == result->kind &&
            request->number == result->number)
            return request;
    }
    return NULL;
}

void requests_take(struct requests *requests, const struct request_result *result)
{
    struct request *request = find(requests, result);
    if (!request) {
        note_service(requests);
        adapt_to_spurious_repeat(&requests->pace[result->kind]);
    } else if (result->status == FMB_BUSY && request->refusals < BUSY_MAX) {
        note_received(requests, result->kind);
        const int doublings =
            request->refusals < BUSY_DOUBLINGS ? request->refusals : BUSY_DOUBLINGS;
        request->refusals++;
        request->pausing = true;
        request->deadline = clock_ns() + ns_per_ms * (BUSY_PAUSE_MS << doublings);
    } else {
        const enum request_taken taken = request->handler(request->user, request, result);
        if (taken == REQUEST_MALFORMED) {
            requests->counts.malformed++;
            return;
        }
        measure(&requests->pace[request->kind], request);
        note_received(requests, request->kind);
        requests->counts.answered++;
        if (taken == REQUEST_COMPLETE)
            request_end(requests, request);
        else
            request_send(requests, request);
    }
}

/* ---- Time ---- */

void requests_give_up(struct requests *requests, int status)
{
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++)
        if (requests->request[i].under_way)
            fail(requests, &requests->request[i], status);
}

static void give_up(struct requests *requests, struct request *request)
{
    if (requests->received_at >= request->first_at) {
        fail(requests, request, FMB_CLIENT_NO_ANSWER);
        return;
    }
    requests->counts.outages += !requests->outage;
    requests->outage = true;
    requests_forget_pace(requests);
    requests_give_up(requests, FMB_CLIENT_NO_SERVICE);
}

/* Presumes a request lost if one that was sent later has its result. */
static void detect_loss(const struct request_pace *pace, struct request *request, int64_t time)
{
    if (request->pausing || request->presumed_lost || request->sent_at >= pace->newest_answered_at)
        return;
    request->presumed_lost = true;
    if (explained_by_loss(request))
        request->deadline = time + pace->reordering_window;
}

/* Whether the service may still have the request in its queue: results of other requests come in,
 * or one that was sent later is repeated first. */
static bool is_queued(const struct request_pace *pace, const struct request *request, int64_t time)
{
    return !request->pausing && (time < pace->received_at + request->interval ||
                                 request->sent_at < pace->newest_sent_at);
}

/* Whether to give a request up. A caller that was away for long has not repeated the query: the
 * request then gets another timeout. */
static bool is_overdue(const struct requests *requests, struct request *request, int64_t time)
{
    if (request->pausing || time < request->give_up_at)
        return false;
    if (request->sent_at >= request->give_up_at - requests->timeout_ns)
        return true;
    request->give_up_at = time + requests->timeout_ns;
    return false;
}

static void check_deadline(struct requests *requests, struct request *request, int64_t time)
{
    const struct request_pace *pace = &requests->pace[request->kind];
    const int64_t received_at = pace->received_at;
    if (!request->under_way)
        return;
    detect_loss(pace, request, time);
    if (time < request->deadline)
        return;
    if (is_overdue(requests, request, time))
        give_up(requests, request);
    else if (!request->presumed_lost && is_queued(pace, request, time))
        request->deadline =
            request->interval + (received_at + request->interval > time ? received_at : time);
    else
        repeat(requests, request);
    if (!request->pausing && request->deadline > request->give_up_at)
        request->deadline = request->give_up_at;
}

static void find_newest_sent(struct requests *requests)
{
    for (int kind = 0; kind < FMB_CLIENT_KINDS; kind++)
        requests->pace[kind].newest_sent_at = 0;
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++) {
        const struct request *request = &requests->request[i];
        struct request_pace *pace = &requests->pace[request->kind];
        if (request->under_way && !request->pausing && request->sent_at > pace->newest_sent_at)
            pace->newest_sent_at = request->sent_at;
    }
}

/* Returns milliseconds to the next deadline, rounded up; at most a second, so that a clock that
 * jumps cannot cause an endless wait. */
static int wait_ms(const struct requests *requests, int64_t until)
{
    const int64_t time = clock_ns();
    int64_t earliest = until - time < ns_per_s ? until : time + ns_per_s;
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW && requests->count > 0; i++) {
        const struct request *request = &requests->request[i];
        if (request->under_way && request->deadline < earliest)
            earliest = request->deadline;
    }
    return earliest > time ? (int) ((earliest - time + ns_per_ms - 1) / ns_per_ms) : 0;
}

/* Pending results are read before queries are repeated: the caller may have been away. */
void requests_step(struct requests *requests, int other_fd, int64_t until)
{
    const struct request_transport *transport = &requests->transport;
    transport->wait(transport->user, other_fd, wait_ms(requests, until));
    if (!transport->receive(transport->user))
        requests_give_up(requests, FMB_CLIENT_NO_BUS);
    if (requests->count == 0)
        return;
    const int64_t time = clock_ns();
    find_newest_sent(requests);
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++)
        check_deadline(requests, &requests->request[i], time);
}
