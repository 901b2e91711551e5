#include "request.h"

#include "big_endian.h"
#include "clock.h"

#include <string.h>

enum {
    /* A busy service is queried again after 10, 20, 40, ... 320, 320, ... milliseconds, a minute in
     * all; then its refusal is the result. */
    BUSY_PAUSE_MS = 10,
    BUSY_DOUBLINGS = 5,
    BUSY_MAX = 200,
    /* Retry: this long after the usual time; and as long as this before that is known. Scenes may
     * take long to decide, and a repeated one is decided again. */
    MARGIN_MS = 8,
    FIRST_RETRY_MS = 10,
    FIRST_SCENE_RETRY_MS = 40,
    /* A stock receive buffer has 212,992 bytes, and it also holds what came from others. A datagram
     * takes at most twice its bytes there, and some for itself; the largest take 70,000. */
    CHARGE_MAX = 150000,
    CHARGE_LARGEST = 70000,
    CHARGE_EACH = 1024,
    /* Where the ids stand that the engine writes: after fingerprint and utime. */
    CLIENT_ID_AT = 16,
    NUMBER_AT = 24
};

static const int64_t ns_per_ms = 1000000, ns_per_s = 1000000000;

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

/* While the service is silent, one request at a time finds out whether it still is. */
bool requests_ready(const struct requests *requests, size_t bytes)
{
    if (requests->count == 0)
        return true;
    return !requests->silent && requests->count < FMB_CLIENT_RAW_WINDOW &&
           requests->charge + charge_of(bytes) <= CHARGE_MAX;
}

static void end(struct requests *requests, struct request *request)
{
    request->under_way = false;
    requests->count--;
    requests->charge -= request->charge;
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
    request->earlier = -1;
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
    request->pausing = false;
    request->sent_at = clock_ns();
    request->deadline = request->sent_at + request->interval;
}

/* How long a request waits for its result, in all. */
static int64_t patience(const struct requests *requests)
{
    return requests->silent ? requests->timeout_ns : requests->timeout_ns * requests->tries;
}

void request_cancel(struct requests *requests, struct request *request)
{
    end(requests, request);
}

/* A query that follows another of the same request may be larger than that. */
static void raise_charge(struct requests *requests, struct request *request)
{
    const size_t charge = charge_of(request->size);
    if (charge <= request->charge)
        return;
    requests->charge += charge - request->charge;
    request->charge = charge;
}

void request_send(struct requests *requests, struct request *request)
{
    const int64_t retry = requests->pace[request->kind].retry;
    raise_charge(requests, request);
    request->number = requests->next_number++;
    big_endian_put_64(request->query + CLIENT_ID_AT, (uint64_t) requests->client_id);
    big_endian_put_64(request->query + NUMBER_AT, (uint64_t) request->number);
    request->interval = retry < requests->timeout_ns ? retry : requests->timeout_ns;
    request->repeated = false;
    requests->counts.queries++;
    publish(requests, request);
    request->first_at = request->sent_at;
    request->give_up_at = request->sent_at + patience(requests);
}

/* The next queries begin with the interval that this one has come to, until one is answered without
 * being repeated. */
static void repeat(struct requests *requests, struct request *request)
{
    struct request_pace *pace = &requests->pace[request->kind];
    if (!request->pausing) {
        request->interval *= 2;
        if (request->interval > requests->timeout_ns)
            request->interval = requests->timeout_ns;
        if (request->interval > pace->retry)
            pace->retry = request->interval;
    } else {
        request->give_up_at = clock_ns() + patience(requests);
    }
    request->repeated = true;
    requests->counts.repeated++;
    publish(requests, request);
}

/* ---- Results ---- */

/* A service is there, even if the result is not of a query that is still under way. */
static void note_heard(struct requests *requests, enum fmb_client_kind kind)
{
    requests->heard_at = requests->pace[kind].heard_at = clock_ns();
    requests->silent = false;
}

/* The result of a repeated query may be that of its first sending: it is no measure. */
static void measure(struct request_pace *pace, const struct request *request)
{
    const int64_t begin = request->sent_at > pace->heard_at ? request->sent_at : pace->heard_at;
    const int64_t time = clock_ns() - begin;
    if (request->first_at > pace->overtaken_at)
        pace->overtaken_at = request->first_at;
    if (request->repeated)
        return;
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

/* NULL: none is under way that the result is of. */
static struct request *find(struct requests *requests, const struct request_result *result)
{
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++) {
        struct request *request = &requests->request[i];
        if (!request->under_way || request->kind != result->kind)
            continue;
        if (request->number == result->number ||
            (request->earlier == result->number && result->status == FMB_OK))
            return request;
    }
    return NULL;
}

static void pause_request(struct request *request)
{
    const int doublings = request->refusals < BUSY_DOUBLINGS ? request->refusals : BUSY_DOUBLINGS;
    request->refusals++;
    request->pausing = true;
    request->deadline = clock_ns() + ns_per_ms * (BUSY_PAUSE_MS << doublings);
}

/* The handler has said what comes next. */
static void proceed(struct requests *requests, struct request *request, enum request_taken taken)
{
    request->earlier = taken == REQUEST_WHOLE ? request->number : -1;
    if (taken == REQUEST_COMPLETE)
        end(requests, request);
    else
        request_send(requests, request);
}

void requests_take(struct requests *requests, const struct request_result *result)
{
    struct request *request = find(requests, result);
    if (!request) {
        requests->counts.contradicting += recent_contradicts(&requests->recent, result);
        note_heard(requests, result->kind);
    } else if (result->status == FMB_BUSY && request->refusals < BUSY_MAX) {
        note_heard(requests, result->kind);
        pause_request(request);
    } else {
        const int64_t number = request->number;
        const enum request_taken taken = request->handler(request->user, request, result);
        if (taken == REQUEST_MALFORMED) {
            requests->counts.malformed++;
            return;
        }
        measure(&requests->pace[request->kind], request);
        note_heard(requests, request->kind);
        requests->counts.answered++;
        recent_note(&requests->recent, result, result->number);
        if (number != result->number)
            recent_note(&requests->recent, result, number);
        proceed(requests, request, taken);
    }
}

/* ---- Time ---- */

void requests_give_up(struct requests *requests, int status)
{
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++) {
        struct request *request = &requests->request[i];
        const struct request_result none = {.kind = request->kind, .status = status, .detail = ""};
        if (!request->under_way)
            continue;
        end(requests, request);
        request->handler(request->user, request, &none);
    }
}

static void give_up(struct requests *requests, struct request *request)
{
    const struct request_result none = {
        .kind = request->kind, .status = FMB_CLIENT_NO_ANSWER, .detail = ""};
    if (requests->heard_at < request->first_at) {
        requests->counts.outages += !requests->silent;
        requests->silent = true;
        requests_forget_pace(requests);
        requests_give_up(requests, FMB_CLIENT_NO_SERVICE);
        return;
    }
    end(requests, request);
    request->handler(request->user, request, &none);
}

/* Whether the service may not have reached the request yet: results of others come in, or none
 * comes and an older one is repeated in its place; and no request has its result that was sent
 * later. */
static bool is_in_line(const struct request_pace *pace, const struct request *request, int64_t time)
{
    const bool expected =
        time < pace->heard_at + request->interval || request->number > pace->oldest;
    return expected && request->sent_at >= pace->overtaken_at;
}

/* A caller that was away for long has not repeated the query: it is given another timeout. */
static bool is_given_up(const struct requests *requests, struct request *request, int64_t time)
{
    if (request->pausing || time < request->give_up_at)
        return false;
    if (request->sent_at >= request->give_up_at - requests->timeout_ns)
        return true;
    request->give_up_at = time + requests->timeout_ns;
    return false;
}

static void look_after(struct requests *requests, struct request *request, int64_t time)
{
    const struct request_pace *pace = &requests->pace[request->kind];
    const int64_t heard_at = pace->heard_at;
    if (!request->under_way || time < request->deadline)
        return;
    if (is_given_up(requests, request, time))
        give_up(requests, request);
    else if (!request->pausing && is_in_line(pace, request, time))
        request->deadline =
            request->interval + (heard_at + request->interval > time ? heard_at : time);
    else
        repeat(requests, request);
    if (!request->pausing && request->deadline > request->give_up_at)
        request->deadline = request->give_up_at;
}

static void note_oldest(struct requests *requests)
{
    for (int kind = 0; kind < FMB_CLIENT_KINDS; kind++)
        requests->pace[kind].oldest = INT64_MAX;
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++) {
        const struct request *request = &requests->request[i];
        struct request_pace *pace = &requests->pace[request->kind];
        if (request->under_way && !request->pausing && request->number < pace->oldest)
            pace->oldest = request->number;
    }
}

/* Milliseconds to the next deadline, rounded up; at most a second, so that a clock that jumps
 * cannot make this wait forever. */
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

/* Results that wait are read before queries are repeated: the caller may have been away. */
void requests_step(struct requests *requests, int other_fd, int64_t until)
{
    const struct request_transport *transport = &requests->transport;
    transport->wait(transport->user, other_fd, wait_ms(requests, until));
    if (!transport->receive(transport->user))
        requests_give_up(requests, FMB_CLIENT_NO_BUS);
    if (requests->count == 0)
        return;
    const int64_t time = clock_ns();
    note_oldest(requests);
    for (int i = 0; i < FMB_CLIENT_RAW_WINDOW; i++)
        look_after(requests, &requests->request[i], time);
}
