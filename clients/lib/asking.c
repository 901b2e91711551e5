#include "asking.h"

#include "client.h"
#include "clock.h"
#include "order.h"
#include "wire.h"

#include <string.h>

enum {
    /* A busy service is asked again after 10, 20, 40, ... 320, 320, ... milliseconds, a minute in
     * all; then its refusal is the answer. */
    BUSY_PAUSE_MS = 10,
    BUSY_DOUBLINGS = 5,
    BUSY_MAX = 200,
    /* A stock receive buffer has 212,992 bytes, and what came from others is in it too. A datagram
     * takes twice its bytes there at most and some for itself; the largest take 70,000. */
    CHARGE_MAX = 150000,
    CHARGE_LARGEST = 70000,
    CHARGE_EACH = 1024,
    /* Pairs listed in a query, before it is known how long they take, and at least. */
    PAIRS_FIRST = 256,
    PAIRS_LEAST = 16,
    PAIRS_GROWTH = 4
};

static const int64_t ns_per_ms = 1000000, ns_per_s = 1000000000;

static struct asking_slot *slot_of(struct asking *asking, uint64_t part)
{
    return &asking->slot[part % ASKING_WINDOW];
}

/* ---- Queries going out ----------------------------------------------------------------------- */

/* A frame whose body the service holds goes by key; once keys have failed twice, none does. */
static void write_frame(struct fmb_client *client, struct asking_slot *slot, unsigned frame,
                        struct query_frame *out)
{
    question_frame(&client->asking.scene->frames[frame], out);
    out->key = slot->unknown < 2 ? keys_find(&client->keys, out) : 0;
    if (out->key)
        out->components.count = 0;
    slot->by_key += out->key != 0;
}

static void write_pair(struct fmb_client *client, struct asking_slot *slot)
{
    const struct fmb_client_scene *scene = client->asking.scene;
    struct pair_query query = {.utime = clock_utime(),
                               .client_id = client->client_id,
                               .sequence_number = slot->number,
                               .duration = scene->duration,
                               .method = scene->method,
                               .want = (int32_t) scene->want & ~QUERY_WANT_TIMES};
    for (int f = 0; f < 2; f++)
        write_frame(client, slot, slot->part.frame[f], &query.frame[f]);
    slot->size = wire_write_pair_query(&query, slot->query);
}

static void write_scene(struct fmb_client *client, struct asking_slot *slot)
{
    const struct fmb_client_scene *scene = client->asking.scene;
    const struct part *part = &slot->part;
    struct scene_query *query = &client->query;
    query->utime = clock_utime();
    query->client_id = client->client_id;
    query->sequence_number = slot->number;
    query->duration = scene->duration;
    query->method = scene->method;
    query->want = (int32_t) scene->want;
    query->which = part->which;
    query->split = part->split;
    query->first_pair = slot->answers.answered;
    query->frame_count = part->frame_count;
    query->index_count = part->which == QUERY_PAIRS_LISTED ? 2 * part->total : 0;
    for (int32_t i = 0; i < part->frame_count; i++)
        write_frame(client, slot, part->frame[i], &query->frame[i]);
    for (int32_t i = 0; i < query->index_count; i++)
        query->pair[i / 2][i % 2] = part->pair[i / 2][i % 2];
    slot->size = wire_write_scene_query(query, slot->query);
}

static void send_slot(struct fmb_client *client, struct asking_slot *slot)
{
    const enum client_intake kind = slot->part.alone ? CLIENT_PAIRS : CLIENT_SCENES;
    if (lcm_publish(client->lcm, client->query_channel[kind], slot->query, (unsigned) slot->size) <
        0)
        client->counts.unsent++;
    client->counts.bytes += slot->size;
    client->counts.by_key += (uint64_t) slot->by_key;
    client->counts.whole += (uint64_t) (slot->part.frame_count - slot->by_key);
    slot->pausing = false;
    slot->deadline = clock_ns() + client->timeout_ns;
}

/* A query that was not asked before: for the part as it stands now. */
static void ask(struct fmb_client *client, struct asking_slot *slot)
{
    slot->number = client->asking.next_number++;
    slot->tries = client->tries - 1;
    slot->by_key = 0;
    slot->first_at = clock_ns();
    (slot->part.alone ? write_pair : write_scene)(client, slot);
    client->counts.queries++;
    send_slot(client, slot);
}

static void finish(struct asking *asking, struct asking_slot *slot)
{
    asking->charge -= slot->charge;
    slot->charge = 0;
    slot->done = true;
}

static void refuse(struct asking *asking, struct asking_slot *slot, int status, const char *text)
{
    part_answers_refuse(&slot->answers, status, text);
    finish(asking, slot);
}

/* ---- Answers coming in ----------------------------------------------------------------------- */

/* There is a service, even if the answer comes too late for its query. */
static void hear(struct asking *asking)
{
    asking->heard_at = clock_ns();
    asking->silent = asking->probing = false;
}

/* The query under way with this number; NULL: there is none, or none any more. */
static struct asking_slot *find_slot(struct asking *asking, int64_t number, bool alone)
{
    for (uint64_t part = asking->oldest; part < asking->next; part++) {
        struct asking_slot *slot = slot_of(asking, part);
        if (!slot->done && slot->number == number && slot->part.alone == alone)
            return slot;
    }
    return NULL;
}

static void pause_slot(struct asking_slot *slot)
{
    const int doublings = slot->refusals < BUSY_DOUBLINGS ? slot->refusals : BUSY_DOUBLINGS;
    slot->refusals++;
    slot->pausing = true;
    slot->deadline = clock_ns() + ns_per_ms * (BUSY_PAUSE_MS << doublings);
}

/* What every result may say, but for its answers. On output: whether it has answers. */
static bool take_status(struct fmb_client *client, struct asking_slot *slot, int32_t status,
                        const char *detail)
{
    if (status == FMB_OK)
        return true;
    hear(&client->asking);
    if (status == FMB_BUSY && slot->refusals < BUSY_MAX) {
        pause_slot(slot);
        return false;
    }
    client->counts.answered++;
    if (status == FMB_UNKNOWN_BODY && slot->by_key > 0) {
        slot->unknown++;
        ask(client, slot);
    } else {
        refuse(&client->asking, slot, status, detail);
    }
    return false;
}

static void take(struct fmb_client *client, struct asking_slot *slot, enum part_taken taken)
{
    hear(&client->asking);
    client->counts.answered++;
    if (taken == PART_NO_MEMORY)
        refuse(&client->asking, slot, FMB_CLIENT_NO_MEMORY, NULL);
    else if (slot->answers.answered < slot->part.total)
        ask(client, slot);
    else
        finish(&client->asking, slot);
}

static void learn(struct fmb_client *client, unsigned frame, int64_t server_id, int64_t key)
{
    struct query_frame whole;
    question_frame(&client->asking.scene->frames[frame], &whole);
    keys_learn(&client->keys, server_id, &whole, key);
}

/* A service that was busy, say, has not looked at the bodies. */
static bool tells_keys(int32_t status)
{
    return status == FMB_OK || status == FMB_UNKNOWN_BODY;
}

/* Those of a refusal tell which frames have to be sent whole. */
static void learn_scene(struct fmb_client *client, const struct asking_slot *slot,
                        const struct scene_result *result)
{
    for (int32_t i = 0; i < result->key_count; i++)
        learn(client, slot->part.frame[i], result->server_id, result->key[i]);
}

/* All under way are to be decided within half a time-out; pairs of this kind take so long. */
static void learn_time(struct fmb_client *client, int32_t pairs, int64_t compute_ns)
{
    struct asking *asking = &client->asking;
    const double share = (double) client->timeout_ns / (2 * ASKING_WINDOW);
    const double each = (double) (compute_ns > 0 ? compute_ns : 1) / pairs;
    int32_t most = PAIRS_GROWTH * asking->pairs_max;
    most = most < QUERY_PAIRS_MAX ? most : QUERY_PAIRS_MAX;
    asking->pairs_max = share / each < most ? (int32_t) (share / each) : most;
    if (asking->pairs_max < PAIRS_LEAST)
        asking->pairs_max = PAIRS_LEAST;
}

/* Whose result it is, and of which query. NULL: of none that is under way. */
static struct asking_slot *slot_for(struct fmb_client *client, int64_t client_id, int64_t number,
                                    bool alone)
{
    if (client_id != client->client_id)
        return NULL;
    struct asking_slot *slot = find_slot(&client->asking, number, alone);
    if (!slot)
        hear(&client->asking);
    return slot;
}

void asking_take_pair(struct fmb_client *client, const struct pair_result *result)
{
    struct asking_slot *slot = slot_for(client, result->client_id, result->sequence_number, true);
    enum part_taken taken = PART_TAKEN;
    if (!slot)
        return;
    if (result->status < FMB_OK) /* those are the library's own */
        taken = PART_NONSENSE;
    else if (result->status == FMB_OK)
        taken = part_take_pair(&slot->part, client->asking.scene, result, &slot->answers);
    if (taken == PART_NONSENSE) {
        client->counts.malformed++;
        return;
    }
    for (int f = 0; f < 2 && tells_keys(result->status); f++)
        learn(client, slot->part.frame[f], result->server_id, result->key[f]);
    if (take_status(client, slot, result->status, result->detail))
        take(client, slot, taken);
}

void asking_take_scene(struct fmb_client *client, const struct scene_result *result)
{
    struct asking_slot *slot = slot_for(client, result->client_id, result->sequence_number, false);
    enum part_taken taken = PART_TAKEN;
    if (!slot)
        return;
    const int32_t before = slot->answers.answered;
    if (result->status < FMB_OK ||
        (result->key_count != 0 && result->key_count != slot->part.frame_count))
        taken = PART_NONSENSE;
    else if (result->status == FMB_OK)
        taken = part_take_scene(&slot->part, client->asking.scene, result, &slot->answers);
    if (taken == PART_NONSENSE) {
        client->counts.malformed++;
        return;
    }
    if (tells_keys(result->status))
        learn_scene(client, slot, result);
    if (result->status == FMB_OK && taken == PART_TAKEN && slot->part.which == QUERY_PAIRS_LISTED)
        learn_time(client, slot->answers.answered - before, result->compute_ns);
    if (take_status(client, slot, result->status, result->detail))
        take(client, slot, taken);
}

/* ---- The window ------------------------------------------------------------------------------ */

static size_t charge_of(size_t bytes)
{
    const size_t charge = 2 * bytes + CHARGE_EACH;
    return charge < CHARGE_LARGEST ? charge : CHARGE_LARGEST;
}

/* Of the query at one end, or of the result at the other. */
static size_t charge_of_part(const struct part *part, const struct fmb_client_scene *scene)
{
    const size_t result = part_result_bytes(part, scene);
    return charge_of(part->bytes > result ? part->bytes : result);
}

/* While nobody answers, a query goes out once in a second, one try, to find out whether somebody
 * does again; the others cost no time. */
static void ask_in_silence(struct fmb_client *client, struct asking_slot *slot)
{
    if (clock_ns() < client->asking.probe_at) {
        refuse(&client->asking, slot, FMB_CLIENT_NOBODY, NULL);
        return;
    }
    client->asking.probing = true;
    client->asking.probe_at = clock_ns() + ns_per_s;
    ask(client, slot);
    slot->tries = 0;
}

static void ask_part(struct fmb_client *client, struct asking_slot *slot, size_t charge)
{
    struct asking *asking = &client->asking;
    slot->refusals = slot->unknown = 0;
    slot->done = false;
    slot->charge = charge;
    asking->charge += charge;
    asking->next++;
    if (slot->part.total == 0)
        finish(asking, slot);
    else if (client->failed)
        refuse(asking, slot, FMB_CLIENT_NO_BUS, NULL);
    else if (asking->until < clock_ns())
        refuse(asking, slot, FMB_CLIENT_LATE, NULL);
    else if (asking->silent)
        ask_in_silence(client, slot);
    else
        ask(client, slot);
}

/* Nothing is asked behind a probe: its answer says whether the others are sent or given up.
 * On output: false once there are no more parts. */
static bool fill_window(struct fmb_client *client, struct cut *cut)
{
    struct asking *asking = &client->asking;
    while (asking->next - asking->oldest < ASKING_WINDOW && !asking->probing) {
        struct asking_slot *slot = slot_of(asking, asking->next);
        if (!asking->cut && !cut_next(cut, asking->pairs_max, &slot->part))
            return false;
        const size_t charge = charge_of_part(&slot->part, asking->scene);
        asking->cut = asking->charge > 0 && asking->charge + charge > CHARGE_MAX;
        if (asking->cut)
            return true;
        ask_part(client, slot, charge);
    }
    return true;
}

/* A probe among them is no longer waited for. */
static void give_up_all(struct asking *asking, int status)
{
    asking->probing = false;
    for (uint64_t part = asking->oldest; part < asking->next; part++)
        if (!slot_of(asking, part)->done)
            refuse(asking, slot_of(asking, part), status, NULL);
}

static void fall_silent(struct fmb_client *client)
{
    struct asking *asking = &client->asking;
    give_up_all(asking, FMB_CLIENT_NOBODY);
    if (!asking->silent)
        client->counts.outages++;
    asking->silent = true;
    asking->probe_at = clock_ns() + ns_per_s;
}

static void look_after(struct fmb_client *client, struct asking_slot *slot, int64_t time)
{
    if (slot->done || time < slot->deadline)
        return;
    if (slot->pausing || slot->tries > 0) {
        slot->tries -= !slot->pausing;
        client->counts.repeated++;
        send_slot(client, slot);
    } else if (client->asking.heard_at < slot->first_at) {
        fall_silent(client);
    } else {
        refuse(&client->asking, slot, FMB_CLIENT_NO_ANSWER, NULL);
    }
}

static void look_after_window(struct fmb_client *client)
{
    struct asking *asking = &client->asking;
    const int64_t time = clock_ns();
    if (client->failed)
        give_up_all(asking, FMB_CLIENT_NO_BUS);
    if (asking->until < time)
        give_up_all(asking, FMB_CLIENT_LATE);
    for (uint64_t part = asking->oldest; part < asking->next; part++)
        look_after(client, slot_of(asking, part), time);
}

/* Milliseconds to the next deadline, rounded up; at most a second, so that no clock can make this
 * wait for ever. */
static int time_to_wait_ms(struct asking *asking)
{
    const int64_t start = clock_ns();
    int64_t earliest = asking->until - start < ns_per_s ? asking->until : start + ns_per_s;
    for (uint64_t part = asking->oldest; part < asking->next; part++) {
        const struct asking_slot *slot = slot_of(asking, part);
        if (!slot->done && slot->deadline < earliest)
            earliest = slot->deadline;
    }
    return earliest > start ? (int) ((earliest - start + ns_per_ms - 1) / ns_per_ms) : 0;
}

static void deliver(struct asking *asking, struct order *order)
{
    while (asking->oldest < asking->next) {
        struct asking_slot *slot = slot_of(asking, asking->oldest);
        if (!slot->done)
            return;
        asking->oldest++;
        order_take(order, &slot->part, &slot->answers);
    }
}

static void begin(struct fmb_client *client, const struct fmb_client_scene *scene)
{
    struct asking *asking = &client->asking;
    const double most = 1e9; /* seconds: some 30 years are for ever */
    const double within = scene->within > 0 && scene->within < most ? scene->within : most;
    if (asking->pairs_max == 0 || asking->method != scene->method || asking->want != scene->want)
        asking->pairs_max = PAIRS_FIRST;
    asking->scene = scene;
    asking->method = scene->method;
    asking->want = scene->want;
    asking->until = clock_ns() + (int64_t) (within * (double) ns_per_s);
}

/* Once the oldest part is done, it is delivered before others are looked after: the caller may take
 * long over the answers, and those to others may have come and wait to be read meanwhile. */
void asking_run(struct fmb_client *client, const struct fmb_client_scene *scene, struct cut *cut,
                struct order *order)
{
    struct asking *asking = &client->asking;
    bool more = true;
    begin(client, scene);
    for (;;) {
        more = more && fill_window(client, cut);
        deliver(asking, order);
        if (asking->oldest < asking->next) {
            const bool *oldest_done = &slot_of(asking, asking->oldest)->done;
            client_listen(client, time_to_wait_ms(asking), oldest_done);
            if (!*oldest_done)
                look_after_window(client);
        } else if (!more) {
            break;
        }
    }
    asking->scene = NULL;
}
