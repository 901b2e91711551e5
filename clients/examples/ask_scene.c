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
    else if (answer->answer.has_contact)
        printf("%d and %d: %s from %g s\n", (int) a, (int) b,
               fmb_verdict_name((int) answer->answer.verdict), answer->answer.contact[0]);
    else
        printf("%d and %d: %s\n", (int) a, (int) b, fmb_verdict_name((int) answer->answer.verdict));
}

int main(void)
{
    struct fmb_client_placement placement[4] = {
        {1, FMB_CUBOID, 3, false, {9, 0, 0, 0, 9, 0, 0, 0, 1}, {0, 0, -1}, {0}}, /* the table */
        {2, FMB_CUBOID, 3, false, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 1, 0}, {0}},
        {3, FMB_CUBOID, 3, false, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {2.5, 1, 0}, {0}},
        {4, FMB_CUBOID, 3, true, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {3.25, 1, 2}, {0, 0, -2}},
    };
    const struct fmb_client_scene scene = {.placements = placement,
                                           .placement_count = 4,
                                           .which = FMB_CLIENT_ALL,
                                           .duration = 1,
                                           .want = FMB_CLIENT_WANT_TIMES};
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
