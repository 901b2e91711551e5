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
    static const double table_size[3] = {2, 1, 0.25}, tool_size[3] = {0.5, 0.5, 1};
    struct fmb_body table, tool;
    fmb_body_make(3, FMB_BOX, table_size, 3, &table);
    fmb_body_make(3, FMB_BOX, tool_size, 3, &tool);
    const struct fmb_placement pair[2] = {
        {.body = &table, .id = 1, .position = {0, 0, 0.125}},
        {.body = &tool,
         .id = 2,
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
