#include "quota.h"

#include "clock.h"

enum { SAMPLES_FIRST = 16, SAMPLES_MAX = 128 };

void quota_add_sample(struct quota *quota, enum queue_fifo fifo, int64_t ns)
{
    if (quota->count[fifo] == 0) {
        quota->count[fifo] = SAMPLES_FIRST;
        quota->sum_ns[fifo] = SAMPLES_FIRST * QUOTA_FLOOR_NS;
    }
    if (quota->count[fifo] == SAMPLES_MAX) {
        quota->count[fifo] /= 2;
        quota->sum_ns[fifo] /= 2;
    }
    quota->count[fifo]++;
    quota->sum_ns[fifo] += ns;
}

int64_t quota_estimate(const struct quota *quota, enum queue_fifo fifo)
{
    const int64_t count = quota->count[fifo];
    const int64_t mean_ns = count > 0 ? quota->sum_ns[fifo] / count : 0;
    return mean_ns > QUOTA_FLOOR_NS ? mean_ns : QUOTA_FLOOR_NS;
}

bool quota_exceeded(const struct quota *quota, const int64_t waiting[QUEUE_FIFOS], int64_t clients)
{
    int64_t count = 0, ns = 0;
    for (int fifo = 0; fifo < QUEUE_FIFOS; fifo++) {
        count += waiting[fifo];
        ns += waiting[fifo] * quota_estimate(quota, (enum queue_fifo) fifo);
    }
    return count > 1 && ns > clock_earlier(QUOTA_CLIENT_NS, QUOTA_ALL_NS / clients);
}

bool quota_take_refusal(struct quota *quota, int64_t now_ns)
{
    const int64_t begin_ns = quota->next_refusal_ns > now_ns ? quota->next_refusal_ns : now_ns;
    if (begin_ns - now_ns > (QUOTA_REFUSALS - 1) * QUOTA_REFUSAL_NS)
        return false;
    quota->next_refusal_ns = begin_ns + QUOTA_REFUSAL_NS;
    return true;
}
