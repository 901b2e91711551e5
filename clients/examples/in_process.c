/* A pair in process, without a bus: a box turned by 45 degrees about z falls on a table.
 *
 *     cc in_process.c $(pkg-config --cflags --libs fmb) -o in_process && ./in_process
 *
 * prints "overlapping from 0.5 s". */
#include <fmb.h>
#include <stdio.h>

int main(void)
{
    static const double table_size[3] = {2, 1, 0.25}, tool_size[3] = {0.5, 0.5, 1};
    struct fmb_body table, tool;
    if (fmb_body_make(3, FMB_BOX, table_size, 3, &table) ||
        fmb_body_make(3, FMB_BOX, tool_size, 3, &tool))
        return 1;
    const struct fmb_placement a = {.body = &table};
    const struct fmb_placement b = {.body = &tool,
                                    .position = {0, 0, 1.125},
                                    .velocity = {0, 0, -1},
                                    .orientation = {0.92388, 0, 0, 0.382683}, /* w, x, y, z */
                                    .orientation_count = 4};
    struct fmb_answer answer;
    const enum fmb_status status = fmb_decide(fmb_method_default(), &a, &b, 1, 0, &answer);
    if (status) {
        puts(fmb_status_text(status));
        return 1;
    }
    printf("%s", fmb_verdict_name(answer.verdict));
    if (answer.has_contact)
        printf(" from %g s", answer.contact[0]);
    printf("\n");
    return 0;
}
