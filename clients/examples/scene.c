/* One scene, decided in this process or by a service: cubes stand in a row on a table, and another
 * one falls. With --bus it needs a running fmbd.
 *
 *     cc scene.c $(pkg-config --cflags --libs fmb-client) -o scene && ./scene && ./scene --bus
 *
 * Both print
 *
 *     table and left: touching from 0 s
 *     table and right: touching from 0 s
 *     table and falling: touching from 1 s
 *     right and falling: overlapping from 0.5 s */
#include <fmb_client.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print(const struct fmb_scene *scene, const unsigned pair[2], int verdict, double time)
{
    printf("%s and %s: %s from %g s\n", scene->placements[pair[0]].name,
           scene->placements[pair[1]].name, fmb_verdict_name(verdict), time);
}

/* Returns NULL, or what is wrong. */
static const char *decide_in_process(const struct fmb_scene *scene)
{
    struct fmb_scene_limits limits;
    fmb_scene_limits_of(scene, &limits);
    void *memory = malloc(fmb_scene_bytes(&limits));
    struct fmb_scene_state *state;
    struct fmb_scene_answers answers;
    const enum fmb_status status =
        memory ? fmb_scene_begin(scene, &limits, memory, &state) : FMB_OVER_LIMIT;
    for (bool done = status != FMB_OK; !done;) {
        done = fmb_scene_step(state, &answers);
        for (size_t k = 0; k < answers.count; k++)
            print(scene, answers.pairs[k], answers.verdicts[k], answers.contacts[k][0]);
    }
    free(memory);
    return status == FMB_OK ? NULL : fmb_status_text(status);
}

static void print_answer(void *user, const struct fmb_client_answer *answer)
{
    const unsigned pair[2] = {answer->a, answer->b};
    if (answer->status)
        printf("%u and %u: %s\n", answer->a, answer->b, answer->text);
    else
        print((const struct fmb_scene *) user, pair, answer->answer.verdict,
              answer->answer.contact[0]);
}

static const char *decide_on_the_bus(const struct fmb_scene *scene)
{
    static char why[FMB_CLIENT_WHY_MAX];
    struct fmb_client *client = fmb_client_open(NULL, why, sizeof why);
    if (!client)
        return why;
    const int status = fmb_client_query(client, scene, print_answer, (void *) scene);
    snprintf(why, sizeof why, "%s", fmb_client_why(client));
    fmb_client_close(client);
    return status == FMB_OK ? NULL : why;
}

int main(int argc, char **argv)
{
    const double table_size[] = {9, 9, 1}, cube_size[] = {1, 1, 1};
    struct fmb_body table, cube;
    fmb_body_make(3, FMB_BOX, table_size, 3, &table);
    fmb_body_make(3, FMB_BOX, cube_size, 3, &cube);
    const struct fmb_placement placements[] = {
        {.body = &table, .position = {4.5, 4.5, -0.5}, .id = 1, .name = "table"},
        {.body = &cube, .position = {1.5, 1.5, 0.5}, .id = 2, .name = "left"},
        {.body = &cube, .position = {3, 1.5, 0.5}, .id = 3, .name = "right"},
        {.body = &cube,
         .position = {3.75, 1.5, 2.5},
         .velocity = {0, 0, -2},
         .orientation = {0.92388, 0, 0, 0.382683}, /* w, x, y, z: 45 degrees about z */
         .orientation_count = 4,
         .id = 4,
         .name = "falling"}};
    const struct fmb_scene scene = {
        .placements = placements, .placement_count = 4, .duration = 1, .want = FMB_WANT_TIMES};
    const bool bus = argc > 1 && strcmp(argv[1], "--bus") == 0;
    const char *error = bus ? decide_on_the_bus(&scene) : decide_in_process(&scene);
    if (error)
        fprintf(stderr, "%s\n", error);
    return error != NULL;
}
