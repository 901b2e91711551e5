/* Two boxes, one turned by 45 degrees about z: do they meet? Needs a running fmbd:
 *
 *     cc posed_pair.c $(pkg-config --cflags --libs fmb-client) -o posed_pair && ./posed_pair
 *
 * prints "overlapping". */
#include <fmb_client.h>
#include <stdio.h>

int main(void)
{
    /* Full sizes, about the origin of the body. */
    const struct fmb_client_frame table = {.shape = FMB_BOX, .components = {2, 1, 0.25}};
    const struct fmb_client_frame tool = {.shape = FMB_BOX, .components = {0.5, 0.5, 1}};
    const struct fmb_client_placement pair[2] = {
        {.body_id = 1, .dim = 3, .frames = &table, .frame_count = 1, .position = {0, 0, 0.125}},
        {.body_id = 2,
         .dim = 3,
         .frames = &tool,
         .frame_count = 1,
         .position = {1.25, 0, 0.625},
         .orientation_count = 4, /* w, x, y, z; of any length */
         .orientation = {0.92388, 0, 0, 0.382683}},
    };
    struct fmb_client_answer answer;
    char why[FMB_CLIENT_WHY_MAX];
    struct fmb_client *client = fmb_client_open(NULL, why, sizeof why);
    if (!client) {
        fprintf(stderr, "%s\n", why);
        return 1;
    }
    const int status = fmb_client_query_pair(client, pair, 0, 0, &answer);
    puts(status == FMB_OK ? fmb_verdict_name((int) answer.answer.verdict) : answer.text);
    fmb_client_close(client);
    return status != FMB_OK;
}
