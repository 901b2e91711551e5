/* busy N: a service over plain LCM that is busy N times, then reports every pair as separated.
 * Prints the sequence number of each query, and whether it was busy, until it is ended. */
#include <lcm/lcm.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "fmb_msgs_pair_query_t.h"
#include "fmb_msgs_pair_result_t.h"

static int refusals;

static void on_query(const lcm_recv_buf_t *buffer, const char *channel,
                     const fmb_msgs_pair_query_t *query, void *lcm)
{
    static char none[] = "";
    const bool busy = refusals > 0;
    const fmb_msgs_pair_result_t result = {
        .client_id = query->client_id,
        .sequence_number = query->sequence_number,
        .status = busy ? FMB_MSGS_PAIR_RESULT_T_STATUS_BUSY : FMB_MSGS_PAIR_RESULT_T_STATUS_OK,
        .verdict =
            busy ? FMB_MSGS_PAIR_RESULT_T_VERDICT_NONE : FMB_MSGS_PAIR_RESULT_T_VERDICT_SEPARATED,
        .detail = none,
        .certificate = none};
    (void) buffer;
    (void) channel;
    refusals -= busy;
    printf("%lld%s\n", (long long) query->sequence_number, busy ? " busy" : "");
    fflush(stdout);
    fmb_msgs_pair_result_t_publish(lcm, "FMB_PAIR_RESULT", &result);
}

int main(int argc, char **argv)
{
    lcm_t *lcm = lcm_create(NULL);
    if (!lcm)
        return 1;
    refusals = argc == 2 ? atoi(argv[1]) : 0;
    fmb_msgs_pair_query_t_subscribe(lcm, "FMB_PAIR_QUERY", on_query, lcm);
    while (lcm_handle(lcm) == 0)
        continue;
    return 1;
}
