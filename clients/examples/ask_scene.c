/* A worked example of libfmb-client: a row of cubes on a table, one of which falls. Needs a running
 * fmbd:
 *
 *     cc ask_scene.c $(pkg-config --cflags --libs fmb-client) -o ask_scene && ./ask_scene */
#include <fmb_client.h>
#include <stdio.h>

static void print_contact(void *user, const struct fmb_client_answer *answer)
{
    const struct fmb_client_placement *placement = user;
    const int64_t a = placement[answer->a].body_id, b = placement[answer->b].body_id;
    if (answer->status)
        printf("%d and %d: %s\n", (int) a, (int) b, answer->text);
    else
        printf("%d and %d: %s from %g s\n", (int) a, (int) b,
               fmb_verdict_name((int) answer->answer.verdict), answer->answer.contact[0]);
}

int main(void)
{
    const struct fmb_client_frame table = {.shape = FMB_BOX, .components = {9, 9, 1}};
    const struct fmb_client_frame cube = {.shape = FMB_BOX, .components = {1, 1, 1}};
    struct fmb_client_placement placement[4] = {
        {.body_id = 1, .frames = &table, .position = {4.5, 4.5, -0.5}},
        {.body_id = 2, .frames = &cube, .position = {1.5, 1.5, 0.5}},
        {.body_id = 3, .frames = &cube, .position = {3, 1.5, 0.5}},
        {.body_id = 4, .frames = &cube, .position = {3.75, 1.5, 2.5}, .velocity = {0, 0, -2}},
    };
    for (int i = 0; i < 4; i++) {
        placement[i].dim = 3;
        placement[i].frame_count = 1;
    }
    const struct fmb_client_scene scene = {
        .placements = placement, .placement_count = 4, .duration = 1, .want = FMB_WANT_TIMES};
    char why[FMB_CLIENT_WHY_MAX];
    struct fmb_client *client = fmb_client_open(NULL, why, sizeof why);
    if (!client) {
        fprintf(stderr, "%s\n", why);
        return 1;
    }
    const int status = fmb_client_query(client, &scene, print_contact, placement);
    if (status)
        fprintf(stderr, "%s\n", fmb_client_why(client));
    fmb_client_close(client);
    return status != 0;
}
