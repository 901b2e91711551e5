/* Measures the time that work takes, excluding time in which the system ran other programs. */
#ifndef METER_H
#define METER_H

#include <stdbool.h>
#include <stdint.h>

/* Clocks, in nanoseconds since any moment. Tests supply their own. */
struct meter_clocks {
    int64_t (*wall_ns)(void);
    int64_t (*cpu_ns)(void); /* of this thread */
};

extern const struct meter_clocks meter_system_clocks;

/* Reading the thread's CPU clock is a system call and takes a microsecond on virtual machines; the
 * wall clock takes a fortieth of that. So spans up to METER_TRUSTED_NS are measured by the wall
 * clock; only longer ones, in which the thread may have been preempted, by the CPU clock. */
enum { METER_TRUSTED_NS = 50000 };

struct meter {
    const struct meter_clocks *clocks;
    int64_t wall_ns;    /* wall clock at the last reading */
    bool based;         /* base_ns is valid */
    int64_t base_ns;    /* CPU clock at its last reading */
    int64_t metered_ns; /* reported since then */
};

void meter_init(struct meter *meter, const struct meter_clocks *clocks);

/* Reads the CPU clock if its last reading is no longer valid, so that the next long span is exact.
 * Otherwise that span is measured by the wall clock. */
void meter_base(struct meter *meter);

/* Nanoseconds of work since the last reading. */
int64_t meter_read(struct meter *meter);

/* Discards the time since the last reading. */
void meter_skip(struct meter *meter);

#endif
