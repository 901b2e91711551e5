/* A worked example of libfmb-client: a row of cubes on a table, one of which falls. Needs a running
 * fmbd:
 *
 *     cc ask_scene.c $(pkg-config --cflags --libs fmb-client) -o ask_scene && ./ask_scene */
#include <fmb_client.h>
#include <stdio.h>

static void print_contact(void *user, const struct fmb_client_answer *answer)
{
    const struct fmb_placement *placement = user;
    const int64_t a = placement[answer->a].id, b = placement[answer->b].id;
    if (answer->status)
        printf("%d and %d: %s\n", (int) a, (int) b, answer->text);
    else
        printf("%d and %d: %s from %g s\n", (int) a, (int) b,
               fmb_verdict_name((int) answer->answer.verdict), answer->answer.contact[0]);
}

int main(void)
{
    static const double table_size[3] = {9, 9, 1}, cube_size[3] = {1, 1, 1};
    struct fmb_body table, cube;
    fmb_body_make(3, FMB_BOX, table_size, 3, &table);
    fmb_body_make(3, FMB_BOX, cube_size, 3, &cube);
    struct fmb_placement placement[4] = {
        {.body = &table, .id = 1, .position = {4.5, 4.5, -0.5}},
        {.body = &cube, .id = 2, .position = {1.5, 1.5, 0.5}},
        {.body = &cube, .id = 3, .position = {3, 1.5, 0.5}},
        {.body = &cube, .id = 4, .position = {3.75, 1.5, 2.5}, .velocity = {0, 0, -2}},
    };
    const struct fmb_scene scene = {
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
