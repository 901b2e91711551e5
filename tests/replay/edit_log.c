/* Copies an event log and spoils the copy: usage says how. */
#include "big_endian.h"
#include "log_draft.h"
#include "log_kind.h"
#include "wire.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char usage[] =
    "usage: edit_log [EDIT...] LOG COPY\n"
    "       edit_log --offset N LOG   prints where event N begins\n"
    "\n"
    "Edits, one after the other; N counts from 0, results or queries in the order of the log:\n"
    "\n"
    "  --flip N           result N says another verdict\n"
    "  --nudge N E        a number of result N is larger by E\n"
    "  --witness N        the first gap of result N has witness points (1, 2, 3) and (4, 5, 6)\n"
    "  --refuse N STATUS  result N has this status, and nothing else\n"
    "  --certify N TEXT   the certificate of result N\n"
    "  --label N TEXT     the label of query N, a scene query\n"
    "  --drop N, --repeat N   result N is not there, or twice\n"
    "  --drop-query N, --repeat-query N  query N is not there, or twice\n"
    "  --client N, --sequence N  client ids or sequence numbers are larger by N\n"
    "  --delay K          results come K events later\n"
    "  --last, --first    all results come after all queries, or before them\n"
    "  --utime N          result N does not echo the utime of its query\n"
    "  --version N        event N is of another message type\n"
    "  --shorten N        event N lacks its last byte\n"
    "  --garbage N        before event N stands what is no event\n"
    "  --prefix P         channels begin with P\n"
    "  --rename FROM TO   events on channel FROM are on TO\n"
    "  --events A B       events from A on and before B only\n";

static _Noreturn void give_up(const char *what)
{
    fprintf(stderr, "edit_log: %s\n", what);
    exit(2);
}

/* ---- Events in memory ---- */

struct event {
    int64_t utime;
    char channel[128];
    unsigned char *data;
    size_t size;
    bool garbage; /* some stands before it */
};

static struct event *event;
static size_t count;

/* All memory that was allocated, to be freed at the end. */
struct block {
    struct block *next;
    max_align_t memory[];
};

static struct block *blocks;

static void *room_for(size_t size)
{
    struct block *block = malloc(sizeof *block + size);
    if (!block)
        give_up("out of memory");
    block->next = blocks;
    blocks = block;
    return block->memory;
}

static void free_all(void)
{
    for (struct block *next; blocks; blocks = next) {
        next = blocks->next;
        free(blocks);
    }
    free(event);
}

static void insert(size_t at, struct event one)
{
    if ((count & (count + 1)) == 0) { /* it is full */
        event = realloc(event, (2 * count + 2) * sizeof *event);
        if (!event)
            give_up("out of memory");
    }
    memmove(&event[at + 1], &event[at], (count - at) * sizeof *event);
    event[at] = one;
    count++;
}

static void take_out(size_t at)
{
    memmove(&event[at], &event[at + 1], (count - at - 1) * sizeof *event);
    count--;
}

static void put(size_t at, const unsigned char *data, size_t size)
{
    event[at].data = room_for(size);
    event[at].size = size;
    memcpy(event[at].data, data, size);
}

static void read_log(const char *path, size_t offset_of)
{
    char why[LOG_WHY_MAX];
    struct log_event one;
    struct log_damage damage;
    struct log_reader *reader = log_open(path, why);
    if (!reader)
        give_up(why);
    while (log_next(reader, &one, &damage) == LOG_EVENT) {
        if (count == offset_of) {
            printf("%lld\n", (long long) one.offset);
            log_close(reader);
            free_all();
            exit(0);
        }
        insert(count, (struct event){.utime = one.utime});
        snprintf(event[count - 1].channel, sizeof event->channel, "%s", one.channel);
        put(count - 1, one.data, one.kept);
    }
    log_close(reader);
}

static void write_log(const char *path)
{
    struct log_draft log = {.size = 0};
    for (size_t i = 0; i < count; i++) {
        if (event[i].garbage)
            log_draft_raw(&log, "what is no event of a log", 25);
        log_draft_event(&log, event[i].channel, event[i].utime, event[i].data, event[i].size);
    }
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(log.bytes, 1, log.size, file) != log.size || fclose(file) != 0)
        give_up("the copy cannot be written");
    log_draft_free(&log);
}

static bool ends_with(const char *text, const char *end)
{
    const size_t a = strlen(text), b = strlen(end);
    return a >= b && strcmp(text + a - b, end) == 0;
}

static bool is_result(size_t i)
{
    return ends_with(event[i].channel, WIRE_PAIR_RESULT) ||
           ends_with(event[i].channel, WIRE_SCENE_RESULT);
}

static bool is_query(size_t i)
{
    return ends_with(event[i].channel, WIRE_PAIR_QUERY) ||
           ends_with(event[i].channel, WIRE_SCENE_QUERY);
}

/* Event n of those that are such. */
static size_t number(bool (*is_such)(size_t), const char *text)
{
    long n = atol(text);
    for (size_t i = 0; i < count; i++)
        if (is_such(i) && n-- == 0)
            return i;
    give_up("there are not so many");
}

static bool is_any(size_t i)
{
    (void) i;
    return true;
}

/* ---- Results ---- */

static struct pair_result pair;
static struct scene_result scene;

/* Changes a result, whichever it is. */
static void change(size_t i, void (*pairs)(const char *), void (*scenes)(const char *),
                   const char *argument)
{
    static unsigned char bytes[QUERY_BYTES_MAX];
    const uint32_t size = (uint32_t) event[i].size;
    if (wire_read_pair_result(event[i].data, size, &pair) == NULL) {
        pairs(argument);
        put(i, bytes, wire_write_pair_result(&pair, bytes));
    } else if (wire_read_scene_result(event[i].data, size, &scene) == NULL) {
        scenes(argument);
        put(i, bytes, wire_write_scene_result(&scene, bytes));
    } else {
        give_up("this result cannot be read");
    }
}

static unsigned char other(unsigned char verdict)
{
    return verdict == FMB_TOUCHING ? FMB_OVERLAPPING : FMB_TOUCHING;
}

static void flip_pair(const char *argument)
{
    (void) argument;
    pair.answer.verdict = (enum fmb_verdict) other((unsigned char) pair.answer.verdict);
    pair.answer.has_contact = true;
}

static void flip_scene(const char *argument)
{
    (void) argument;
    for (int32_t i = 0; i < scene.verdict_count; i++)
        if (scene.verdict[i] >= FMB_TOUCHING) {
            scene.verdict[i] = other(scene.verdict[i]);
            return;
        }
    give_up("this scene has no contact");
}

static void nudge_pair(const char *argument)
{
    if (pair.answer.has_box)
        pair.answer.box[1][0] += atof(argument);
    else if (pair.answer.has_contact)
        pair.answer.contact[1] += atof(argument);
    else if (pair.answer.has_gap)
        pair.answer.gap.bounds[1] += atof(argument);
    else
        give_up("this result has no numbers");
}

static void nudge_scene(const char *argument)
{
    if (scene.has_boxes)
        scene.boxes[scene.dim] += atof(argument);
    else if (scene.has_times)
        scene.times[1] += atof(argument);
    else if (scene.has_gaps)
        scene.gap[0].bounds[1] += atof(argument);
    else
        give_up("this result has no numbers");
}

/* At time 0. */
static void set_witness(struct fmb_gap *gap)
{
    gap->has_witness = true;
    for (int i = 0; i < 6; i++)
        gap->witness[i / 3][i % 3] = 1 + i;
}

static void witness_pair(const char *argument)
{
    (void) argument;
    set_witness(&pair.answer.gap);
}

static void witness_scene(const char *argument)
{
    (void) argument;
    set_witness(&scene.gap[0]);
}

static void refuse_pair(const char *status)
{
    pair = (struct pair_result){.utime = pair.utime,
                                .client_id = pair.client_id,
                                .sequence_number = pair.sequence_number,
                                .status = atoi(status)};
}

static void refuse_scene(const char *status)
{
    scene.status = atoi(status);
    scene.unknown_count = scene.status == FMB_UNKNOWN_BODY;
    scene.unknown[0] = 0;
    scene.handle_count = scene.verdict_count = scene.contact_count = 0;
    scene.names_pairs = scene.has_times = scene.has_boxes = false;
    scene.has_points = scene.has_gaps = false;
}

static void certify_pair(const char *text)
{
    pair.certificate = text;
}

static void certify_scene(const char *text)
{
    (void) text;
    give_up("scenes have no certificates");
}

static void late_pair(const char *argument)
{
    (void) argument;
    pair.utime++;
}

static void late_scene(const char *argument)
{
    (void) argument;
    scene.utime++;
}

/* ---- Edits ---- */

static void flip(char **argument)
{
    change(number(is_result, argument[0]), flip_pair, flip_scene, NULL);
}

static void witness(char **argument)
{
    change(number(is_result, argument[0]), witness_pair, witness_scene, NULL);
}

static void nudge(char **argument)
{
    change(number(is_result, argument[0]), nudge_pair, nudge_scene, argument[1]);
}

static void refuse(char **argument)
{
    change(number(is_result, argument[0]), refuse_pair, refuse_scene, argument[1]);
}

static void certify(char **argument)
{
    change(number(is_result, argument[0]), certify_pair, certify_scene, argument[1]);
}

static void utime(char **argument)
{
    change(number(is_result, argument[0]), late_pair, late_scene, NULL);
}

static void drop(char **argument)
{
    take_out(number(is_result, argument[0]));
}

static void drop_query(char **argument)
{
    take_out(number(is_query, argument[0]));
}

/* The label follows the fingerprint, the time and both ids: its length, and its text with the
 * terminating 0. */
static void label(char **argument)
{
    enum { LABEL = 32 };
    const size_t at = number(is_query, argument[0]), now = strlen(argument[1]) + 1;
    const unsigned char *data = event[at].data;
    const size_t then = data[LABEL + 2] << 8 | data[LABEL + 3], size = event[at].size - then + now;
    if (!ends_with(event[at].channel, WIRE_SCENE_QUERY) || now > UINT8_MAX)
        give_up("the query is of a pair, or the label is too long");
    unsigned char *out = room_for(size);
    memcpy(out, data, LABEL);
    memcpy(out + LABEL, (unsigned char[4]){0, 0, 0, (unsigned char) now}, 4);
    memcpy(out + LABEL + 4, argument[1], now);
    memcpy(out + LABEL + 4 + now, data + LABEL + 4 + then, size - LABEL - 4 - now);
    event[at].data = out;
    event[at].size = size;
}

static void repeat(char **argument)
{
    const size_t at = number(is_result, argument[0]);
    insert(at, event[at]);
    put(at, event[at].data, event[at].size);
}

static void repeat_query(char **argument)
{
    const size_t at = number(is_query, argument[0]);
    insert(at, event[at]);
    put(at, event[at].data, event[at].size);
}

/* Adds to the number at this offset of each query and result. */
static void add(size_t offset, uint64_t addend)
{
    for (size_t i = 0; i < count; i++) {
        if (!is_query(i) && !is_result(i))
            continue;
        uint64_t sum = big_endian_64(event[i].data + offset) + addend;
        for (size_t byte = 8; byte-- > 0; sum >>= 8)
            event[i].data[offset + byte] = (unsigned char) sum;
    }
}

/* A message begins with its fingerprint and its utime. */
static void add_client(char **argument)
{
    add(16, (uint64_t) atoll(argument[0]));
}

static void add_sequence(char **argument)
{
    add(24, (uint64_t) atoll(argument[0]));
}

/* The order of events: by place, of results with so much added to it. */
struct turn {
    double at;
    struct event event;
};

static int compare_turns(const void *left, const void *right)
{
    const struct turn *a = left, *b = right;
    return a->at < b->at ? -1 : a->at > b->at;
}

static void move_results(double by)
{
    struct turn *turn = room_for((count + 1) * sizeof *turn);
    for (size_t i = 0; i < count; i++)
        turn[i] = (struct turn){(double) i + (is_result(i) ? by : 0), event[i]};
    qsort(turn, count, sizeof *turn, compare_turns);
    for (size_t i = 0; i < count; i++)
        event[i] = turn[i].event;
}

static void delay(char **argument)
{
    move_results(atof(argument[0]) + 0.5);
}

static void last(char **argument)
{
    (void) argument;
    move_results((double) count);
}

static void first(char **argument)
{
    (void) argument;
    move_results(-(double) count);
}

static void version(char **argument)
{
    event[number(is_any, argument[0])].data[7] ^= 1;
}

static void shorten(char **argument)
{
    event[number(is_any, argument[0])].size--;
}

static void garbage(char **argument)
{
    event[number(is_any, argument[0])].garbage = true;
}

static void prefix(char **argument)
{
    for (size_t i = 0; i < count; i++) {
        char name[sizeof event->channel];
        snprintf(name, sizeof name, "%.20s%.100s", argument[0], event[i].channel);
        memcpy(event[i].channel, name, sizeof name);
    }
}

static void rename_channel(char **argument)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(event[i].channel, argument[0]) == 0)
            snprintf(event[i].channel, sizeof event->channel, "%s", argument[1]);
}

static void some(char **argument)
{
    const size_t from = (size_t) atol(argument[0]), to = (size_t) atol(argument[1]);
    count = count < to ? count : to;
    for (size_t i = 0; i < from && count > 0; i++)
        take_out(0);
}

static const struct edit {
    const char *name;
    int arguments;
    void (*make)(char **argument);
} edits[] = {
    {"--flip", 1, flip},
    {"--nudge", 2, nudge},
    {"--witness", 1, witness},
    {"--certify", 2, certify},
    {"--utime", 1, utime},
    {"--drop", 1, drop},
    {"--drop-query", 1, drop_query},
    {"--repeat", 1, repeat},
    {"--delay", 1, delay},
    {"--last", 0, last},
    {"--first", 0, first},
    {"--version", 1, version},
    {"--shorten", 1, shorten},
    {"--garbage", 1, garbage},
    {"--prefix", 1, prefix},
    {"--rename", 2, rename_channel},
    {"--events", 2, some},
    {"--refuse", 2, refuse},
    {"--repeat-query", 1, repeat_query},
    {"--label", 2, label},
    {"--client", 1, add_client},
    {"--sequence", 1, add_sequence},
};

static const struct edit *find_edit(const char *name)
{
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++)
        if (strcmp(edits[i].name, name) == 0)
            return &edits[i];
    give_up(usage);
}

int main(int argc, char **argv)
{
    if (argc == 4 && strcmp(argv[1], "--offset") == 0) {
        read_log(argv[3], (size_t) atol(argv[2]));
        give_up("there are not so many");
    }
    if (argc < 3)
        give_up(usage);
    read_log(argv[argc - 2], SIZE_MAX);
    for (int i = 1; i < argc - 2;) {
        const struct edit *edit = find_edit(argv[i]);
        if (i + edit->arguments >= argc - 2)
            give_up(usage);
        edit->make(argv + i + 1);
        i += 1 + edit->arguments;
    }
    write_log(argv[argc - 1]);
    free_all();
    return 0;
}
