/* Round trips of one query at a time: pairs and scenes, for each form of their bodies, beside the
 * echo's of the same sizes. */
#include <stdio.h>

#include "duel.h"
#include "workload.h"

static void put_form(struct bus_bench *bench, enum form form)
{
    json_number(&bench->json, "cores", bench->cpus.cores);
    json_string(&bench->json, "form", form_name(form));
}

void trips_pairs(struct bus_bench *bench)
{
    static struct datagram query;
    for (int form = 0; form < FORMS; form++) {
        char name[64];
        workload_pair(bench, (enum form) form, &query);
        const struct duel duel = duel_run(bench, &query, bench->blocks, bench->trips);
        snprintf(name, sizeof name, "pair %s", form_name((enum form) form));
        duel_print(name, &duel);
        json_begin(&bench->json, NULL, '{');
        put_form(bench, (enum form) form);
        duel_put(&bench->json, &duel);
        json_end(&bench->json, '}');
    }
}

static void trips_of_scene(struct bus_bench *bench, int bodies, enum form form)
{
    static struct datagram query;
    enum { PAIRS = 200 };
    struct workload_scene scene = workload_scene_draw(bodies, PAIRS, bench->seed);
    char name[64];
    const size_t pairs = workload_scene(bench, &scene, form, &query);
    const struct duel duel = duel_run(bench, &query, bench->blocks / 3 + 1, bench->scene_trips);
    snprintf(name, sizeof name, "scene of %d %s", bodies, form_name(form));
    duel_print(name, &duel);
    json_begin(&bench->json, NULL, '{');
    put_form(bench, form);
    json_number(&bench->json, "bodies", bodies);
    json_number(&bench->json, "pairs", (double) pairs);
    duel_put(&bench->json, &duel);
    json_end(&bench->json, '}');
    workload_scene_free(&scene);
}

/* As many bodies as a query holds whole beside the pairs, and fewer. */
void trips_scenes(struct bus_bench *bench)
{
    static const int bodies[] = {100, 338};
    for (int i = 0; i < 2; i++)
        for (int form = 0; form < FORMS; form++)
            trips_of_scene(bench, bodies[i], (enum form) form);
}
