/* Streams the states of a robot: an arm of ten links, each of two boxes, that curls over a table.
 * Neighbouring links are ignored: they always meet at their joint. Each state takes one query;
 * bodies are sent whole once, and by handle from then on, however they turn. Needs a running fmbd:
 *
 *     cc robot.c $(pkg-config --cflags --libs fmb-client) -lm -o robot && ./robot */
#include <fmb_client.h>
#include <math.h>
#include <stdio.h>

enum { LINKS = 10, BODIES = LINKS + 1, STATES = 30 };

static struct fmb_placement placement[BODIES]; /* links; the table */

/* All joints bend by the same angle. Each link begins where the one before it ends. */
static void pose(double bend)
{
    double joint[3] = {0, 0, 1}, pitch = 0;
    for (int i = 0; i < LINKS; i++, pitch += bend) {
        const double middle[3] = {cos(pitch) / 2, 0, -sin(pitch) / 2};
        for (int axis = 0; axis < 3; axis++) {
            placement[i].position[axis] = joint[axis] + middle[axis];
            joint[axis] += 2 * middle[axis];
        }
        placement[i].orientation_count = 4; /* about y */
        placement[i].orientation[0] = cos(pitch / 2);
        placement[i].orientation[2] = sin(pitch / 2);
    }
}

static void print_contact(void *user, const struct fmb_client_answer *answer)
{
    const char *what =
        answer->status ? answer->text : fmb_verdict_name((int) answer->answer.verdict);
    printf("  state %d: %u and %u: %s\n", *(const int *) user, answer->a, answer->b, what);
}

int main(void)
{
    static const double boxes[2][6] = {{0, 0, 0, 1, 0.2, 0.1}, {0.4, 0, 0, 0.2, 0.3, 0.2}};
    static const double table_size[3] = {20, 20, 1};
    struct fmb_frame frame[2];
    struct fmb_body link, table;
    unsigned neighbours[LINKS - 1][2];
    char why[FMB_CLIENT_WHY_MAX];
    for (int i = 0; i < 2; i++)
        fmb_frame_make(3, FMB_BOX, boxes[i], 6, &frame[i]);
    fmb_body_make_frames(frame, 2, &link);
    fmb_body_make(3, FMB_BOX, table_size, 3, &table);
    for (int i = 0; i < BODIES; i++)
        placement[i] = (struct fmb_placement){.body = i < LINKS ? &link : &table, .id = i + 1};
    placement[LINKS].position[2] = -1;
    for (unsigned i = 0; i + 1 < LINKS; i++)
        neighbours[i][0] = i, neighbours[i][1] = i + 1;
    const struct fmb_scene scene = {.placements = placement,
                                    .placement_count = BODIES,
                                    .ignored = (const unsigned(*)[2]) neighbours,
                                    .ignored_count = LINKS - 1};
    struct fmb_client *client = fmb_client_open(NULL, why, sizeof why);
    int status = client ? FMB_OK : FMB_CLIENT_NO_BUS;
    for (int state = 0; state < STATES && status == FMB_OK; state++) {
        pose(0.02 * state);
        status = fmb_client_query(client, &scene, print_contact, &state);
    }
    if (status != FMB_OK) {
        fprintf(stderr, "%s\n", client ? fmb_client_why(client) : why);
        fmb_client_close(client);
        return 1;
    }
    struct fmb_client_counts counts;
    fmb_client_get_counts(client, &counts);
    printf("%d states: %d queries, %d bodies whole, %d by handle\n", STATES, (int) counts.queries,
           (int) counts.whole, (int) counts.by_handle);
    fmb_client_close(client);
    return 0;
}
