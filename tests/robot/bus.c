/* States of a robot from bus to bus, on one core: the links and obstacles by handle, and whole. In
 * a network of its own: netns. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "geometry_write.h"
#include "guard.h"
#include "line.h"
#include "parties.h"
#include "states.h"
#include "stopwatch.h"

enum { ROUNDS = 25, GEOMETRY_MAX = ROBOT_FRAMES * GEOMETRY_FRAME_BYTES_MAX };

static const double answer_seconds = 3;

static void fail(const char *what)
{
    fprintf(stderr, "robot-bus: %s\n", what);
    exit(EXIT_FAILURE);
}

/* ---- Queries ---- */

static struct plain_frame frame_of(const struct fmb_frame *frame)
{
    struct plain_frame out = {.shape = (int) frame->shape};
    const bool box = frame->shape == FMB_BOX;
    memcpy(out.origin, box ? frame->centre : frame->origin, sizeof out.origin);
    for (int i = 0; i < 3; i++)
        if (box)
            out.components[i] = frame->component[i][i];
        else
            memcpy(out.components + 3 * i, frame->component[i], sizeof frame->component[i]);
    return out;
}

static void set_whole(const struct fmb_placement *from, int body, struct query_placement *out)
{
    static unsigned char bytes[ROBOT_BODIES][GEOMETRY_MAX];
    struct plain_frame frame[ROBOT_FRAMES];
    const unsigned count = from->body->frame_count;
    *out = (struct query_placement){.placed.id = 1 + body,
                                    .body.dim = 3,
                                    .body.frame_count = (int32_t) count,
                                    .placed.orientation_count = 4};
    for (unsigned i = 0; i < count; i++) {
        frame[i] = frame_of(fmb_body_frame(from->body, i));
        out->body.number_count += geometry_number_count(3, frame[i].shape, 0);
    }
    out->body = geometry_write_frames(3, frame, (int) count, bytes[body]);
    memcpy(out->placed.position, from->position, sizeof out->placed.position);
    memcpy(out->placed.orientation, from->orientation, sizeof out->placed.orientation);
}

static void set_query(const struct robot *robot, int state, const struct line *line,
                      struct scene_query *out)
{
    memset(out, 0, sizeof *out);
    out->client_id = line->client_id;
    out->which = FMB_PAIRS_ALL;
    out->placement_count = ROBOT_BODIES;
    out->ignored_count = 2 * ROBOT_NEIGHBOURS;
    memcpy(out->ignored, robot->neighbour, sizeof robot->neighbour);
    for (int i = 0; i < ROBOT_BODIES; i++)
        set_whole(&robot->placement[state][i], i, &out->placement[i]);
}

static void set_handles(const struct handle *handle, struct scene_query *out)
{
    for (int i = 0; i < ROBOT_BODIES; i++)
        out->placement[i].body = geometry_named(3, &handle[i]);
}

/* ---- Measuring ---- */

static double round_trip(struct line *line, struct datagram *datagram)
{
    guard_begin(answer_seconds);
    const double ns = line_round_trip(line, datagram);
    guard_end();
    if (isnan(ns))
        fail("a query was not answered");
    if (line->status != FMB_OK)
        fail(fmb_status_text(line->status));
    return ns * 1e-3;
}

static void measure(const char *name, struct line *line, struct datagram *datagram)
{
    static double time[ROUNDS * ROBOT_STATES], compute[ROUNDS * ROBOT_STATES];
    int count = 0;
    for (int round = 0; round < ROUNDS; round++)
        for (int state = 0; state < ROBOT_STATES; state++, count++) {
            time[count] = round_trip(line, &datagram[state]);
            compute[count] = (double) line->compute_ns * 1e-3;
        }
    const struct spread trip = spread_of(time, count), inside = spread_of(compute, count);
    printf("%-24s %6zu bytes  %8.1f us a state (quartiles %.1f, %.1f), %.1f of them computing\n",
           name, datagram->size, trip.median, trip.low, trip.high, inside.median);
}

static void run(const struct robot *robot, struct line *line)
{
    static struct datagram whole[ROBOT_STATES], by_handle[ROBOT_STATES];
    static struct scene_query query;
    static struct scene_result result;
    for (int state = 0; state < ROBOT_STATES; state++) {
        set_query(robot, state, line, &query);
        datagram_of_scene(&query, &whole[state]);
        if (state == 0) {
            round_trip(line, &whole[0]);
            if (wire_read_scene_result(line->bytes, (uint32_t) line->size, &result))
                fail("a result that cannot be read");
        }
        set_handles(result.handle, &query);
        datagram_of_scene(&query, &by_handle[state]);
    }
    measure("bodies by handle", line, by_handle);
    measure("bodies whole, held", line, whole);
}

int main(void)
{
    struct cpus cpus;
    struct parties parties;
    static struct line line;
    struct robot *robot = malloc(sizeof *robot);
    if (!robot)
        fail("out of memory");
    robot_draw(robot);
    if (!parties_cpus(1, &cpus) || !parties_start(&cpus, &parties))
        fail("fmbd does not start");
    if (line_open(parties.service_url, false, &line))
        run(robot, &line);
    else
        fprintf(stderr, "robot-bus: fmbd does not answer: %s\n", parties_log());
    line_close(&line);
    parties_stop(&parties);
    free(robot);
    return EXIT_SUCCESS;
}
