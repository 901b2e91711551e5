/* The pairs of the campaigns, hulls, posed bodies and shapes with a radius among them, through the
 * service: in both orders, first with whole bodies, then by handle. The bus is given by
 * LCM_DEFAULT_URL; the program waits for a slow recorder on it.
 *
 * soak-families [PREFIX]: one pair of each cell of the families whose names begin so; of each
 * seventh cell with FMB_FAST. Prints a line of JSON. Exit code 0: each answer was that of
 * fmb_decide(), bit for bit. */
#include "fmb_client.h"
#include "query.h"
#include "receivers.h"
#include "round.h"
#include "trial.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t seed = 20261124;
enum { WANT = FMB_WANT_BOX | FMB_WANT_GAP };

struct soak {
    struct fmb_client *client;
    int64_t id; /* the last one given to a body */
    int64_t pairs, failed, different;
};

static void query_both(struct soak *soak, const struct trial *trial)
{
    struct fmb_placement pair[2] = {trial->pair[0].a, trial->pair[0].b};
    for (int f = 0; f < 2; f++)
        pair[f].id = ++soak->id;
    for (int order = 0; order < 2; order++) {
        const struct fmb_placement asked[2] = {pair[order], pair[1 - order]};
        const double duration = trial->question.duration;
        struct fmb_client_answer answer;
        struct fmb_answer expected;
        soak->pairs++;
        receivers_wait();
        if (fmb_decide(fmb_method_default(), &asked[0], &asked[1], duration, WANT, &expected) !=
                FMB_OK ||
            fmb_client_query_pair(soak->client, asked, duration, WANT, &answer) != FMB_OK)
            soak->failed++;
        else if (!query_same_answer(&answer.answer, &expected))
            soak->different++;
        else
            continue;
        question_print(&trial->question);
    }
}

static void query_family(struct soak *soak, const struct family *family)
{
    struct cell cell[CELL_OF_ALL_SHAPES];
    const int count = family_cells(family, cell), step = getenv("FMB_FAST") ? 7 : 1;
    for (int i = 0; i < count; i += step) {
        struct draw draw = cell_draw(seed, family->name, &cell[i], 0);
        static struct trial trial;
        struct question question;
        family_draw(family, &cell[i], &draw, &question);
        trial_begin(&question, &trial);
        query_both(soak, &trial);
        trial_end(&trial);
    }
}

int main(int argc, char **argv)
{
    char why[FMB_CLIENT_WHY_MAX];
    const char *prefix = argc > 1 ? argv[1] : "";
    struct soak soak = {.client = fmb_client_open(NULL, why, sizeof why)};
    if (!soak.client) {
        fprintf(stderr, "soak-families: %s\n", why);
        return 2;
    }
    for (size_t i = 0; family_all_at(i); i++)
        if (strncmp(family_all_at(i)->name, prefix, strlen(prefix)) == 0)
            query_family(&soak, family_all_at(i));
    fmb_client_close(soak.client);
    printf("{\"pairs\": %" PRId64 ", \"failed\": %" PRId64 ", \"different\": %" PRId64 "}\n",
           soak.pairs, soak.failed, soak.different);
    return soak.pairs == 0 || soak.failed > 0 || soak.different > 0;
}
