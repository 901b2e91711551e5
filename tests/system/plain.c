/* plain: a client over plain LCM, without libfmb-client: lcm-gen's types, and liblcm's receiver.
 *
 * Sends a pair query with whole bodies, the same by the handles of the result, and one by the
 * handle of a body that no service holds; then the largest scene query that is served (63,900
 * bytes). Prints statuses, verdicts and boxes, and the counts of verdicts and handles. Exit code 0:
 * each had its result.
 *
 * plain fragments: sends a scene query of 601 cubes, which LCM divides into fragments, and prints
 * its bytes. Exit code 0: publish() reported no error. */
#include <lcm/lcm.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"
#include "fmb_msgs_scene_query_t.h"
#include "fmb_msgs_scene_result_t.h"

/* A scene query of 86 bytes, 186 for each cube and 4 for each pair. */
enum { CUBES = 343, PAIRS = 4, LARGEST = 86 + 186 * CUBES + 4 * PAIRS, TRIES = 20, WAIT_MS = 500 };
enum { TOO_MANY = 601 };
_Static_assert(LARGEST == 63900, "the largest query");

static const int64_t client_id = 4711;

struct pair_answer {
    bool answered;
    int64_t sequence_number; /* of the query that it answers */
    unsigned char handle[2][16];
};

static struct pair_answer pair;

static fmb_msgs_placement_t cube_at(int64_t id, double *position)
{
    static char none[] = "";
    static uint8_t shape = FMB_MSGS_PLACEMENT_T_SHAPE_CUBOID;
    static double numbers[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    return (fmb_msgs_placement_t){.body_id = id,
                                  .dim = 3,
                                  .num_frames = 1,
                                  .shapes = &shape,
                                  .num_numbers = 12,
                                  .numbers = numbers,
                                  .name = none,
                                  .position = position};
}

static void on_pair(const lcm_recv_buf_t *buffer, const char *channel,
                    const fmb_msgs_pair_result_t *result, void *user)
{
    (void) buffer;
    (void) channel;
    (void) user;
    if (result->client_id != client_id || result->sequence_number != pair.sequence_number ||
        pair.answered)
        return;
    pair.answered = true;
    if (result->sequence_number == 0) {
        memcpy(pair.handle[0], result->handle_a, sizeof pair.handle[0]);
        memcpy(pair.handle[1], result->handle_b, sizeof pair.handle[1]);
    }
    if (result->status == FMB_MSGS_PAIR_RESULT_T_STATUS_OK)
        printf("verdict %d, box %g to %g\n", result->verdict, result->box[0], result->box[3]);
    else
        printf("status %d\n", result->status);
}

static void on_scene(const lcm_recv_buf_t *buffer, const char *channel,
                     const fmb_msgs_scene_result_t *result, void *user)
{
    (void) buffer;
    (void) channel;
    if (result->client_id != client_id || *(bool *) user)
        return;
    *(bool *) user = true;
    printf("status %d, %d verdicts, %d handles\n", result->status, result->num_verdicts,
           result->num_handle_bytes / 16);
}

/* Sends whole bodies in the first query, and handles in later ones. */
static void send_pair(lcm_t *lcm)
{
    static double position[2][3] = {{0, 0, 0}, {0.5, 0, 0}};
    fmb_msgs_pair_query_t query = {.client_id = client_id,
                                   .sequence_number = pair.sequence_number,
                                   .want = FMB_MSGS_PAIR_QUERY_T_WANT_BOX,
                                   .a = cube_at(1, position[0]),
                                   .b = cube_at(2, position[1])};
    fmb_msgs_placement_t *placement[2] = {&query.a, &query.b};
    for (int i = 0; i < 2 && pair.sequence_number > 0; i++) {
        placement[i]->num_frames = placement[i]->num_numbers = 0;
        memcpy(placement[i]->handle, pair.handle[i], sizeof pair.handle[i]);
    }
    fmb_msgs_pair_query_t_publish(lcm, "FMB_PAIR_QUERY", &query);
}

static fmb_msgs_scene_query_t scene_of(int cubes)
{
    static double position[TOO_MANY][3];
    static fmb_msgs_placement_t placement[TOO_MANY];
    static int16_t index[2 * PAIRS];
    for (int i = 0; i < cubes; i++) {
        position[i][0] = 0.75 * i;
        placement[i] = cube_at(1 + i, position[i]);
    }
    for (int i = 0; i < 2 * PAIRS; i++)
        index[i] = (int16_t) (i / 2 + i % 2);
    static char label[] = "s";
    return (fmb_msgs_scene_query_t){.client_id = client_id,
                                    .sequence_number = 1,
                                    .label = label,
                                    .which = FMB_MSGS_SCENE_QUERY_T_PAIRS_LISTED,
                                    .num_placements = cubes,
                                    .placements = placement,
                                    .num_indices = 2 * PAIRS,
                                    .indices = index};
}

static void send_scene(lcm_t *lcm)
{
    const fmb_msgs_scene_query_t query = scene_of(CUBES);
    if (fmb_msgs_scene_query_t_encoded_size(&query) == LARGEST)
        fmb_msgs_scene_query_t_publish(lcm, "FMB_SCENE_QUERY", &query);
}

static bool send_fragments(lcm_t *lcm)
{
    const fmb_msgs_scene_query_t query = scene_of(TOO_MANY);
    printf("%d\n", fmb_msgs_scene_query_t_encoded_size(&query));
    return fmb_msgs_scene_query_t_publish(lcm, "FMB_SCENE_QUERY", &query) == 0;
}

/* LCM loses datagrams: a query is sent until its result comes. */
static bool query(lcm_t *lcm, void (*send)(lcm_t *lcm), const bool *answered)
{
    for (int i = 0; i < TRIES && !*answered; i++) {
        send(lcm);
        while (!*answered && lcm_handle_timeout(lcm, WAIT_MS) > 0)
            continue;
    }
    return *answered;
}

/* With whole bodies, then by handles, then with a handle of no body. */
static bool query_pairs(lcm_t *lcm)
{
    bool all = true;
    for (int i = 0; i < 3 && all; i++) {
        pair.answered = false;
        pair.sequence_number = i;
        pair.handle[1][0] ^= i == 2;
        all = query(lcm, send_pair, &pair.answered);
    }
    return all;
}

int main(int argc, char **argv)
{
    bool scene = false;
    lcm_t *lcm = lcm_create(NULL);
    if (!lcm)
        return 1;
    if (argc == 2 && strcmp(argv[1], "fragments") == 0) {
        const bool sent = send_fragments(lcm);
        lcm_destroy(lcm);
        return sent ? 0 : 1;
    }
    fmb_msgs_pair_result_t_subscribe(lcm, "FMB_PAIR_RESULT", on_pair, NULL);
    fmb_msgs_scene_result_t_subscribe(lcm, "FMB_SCENE_RESULT", on_scene, &scene);
    const bool answered = query_pairs(lcm) && query(lcm, send_scene, &scene);
    lcm_destroy(lcm);
    return answered ? 0 : 1;
}
