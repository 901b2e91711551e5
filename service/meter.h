/* Measures the time that work takes, excluding time in which the system ran other programs. A meter
 * belongs to one thread. */
#ifndef METER_H
#define METER_H

#include <stdbool.h>
#include <stdint.h>

/* Clocks, in nanoseconds since an arbitrary moment. Tests supply their own. */
struct meter_clocks {
    int64_t (*wall_ns)(void);
    int64_t (*cpu_ns)(void); /* of this thread */
};

extern const struct meter_clocks meter_system_clocks;

/* Reading the thread's CPU clock is a system call and takes a microsecond on virtual machines; the
 * wall clock takes a fortieth of that. So spans up to METER_TRUSTED_NS are measured by the wall
 * clock. Only longer spans, in which the thread may have been preempted, are measured by the CPU
 * clock. */
enum { METER_TRUSTED_NS = 50000 };

struct meter {
    const struct meter_clocks *clocks;
    int64_t wall_ns;    /* wall clock at the last reading */
    bool based;         /* base_ns is valid */
    int64_t base_ns;    /* CPU clock when it was last read */
    int64_t metered_ns; /* sum of what meter_read() has returned since then */
};

/* Begins the first span. On input: clocks, which must outlive the meter. */
void meter_init(struct meter *meter, const struct meter_clocks *clocks);

/* Reads the CPU clock if base_ns is not valid (after meter_init() and meter_skip()). Without this
 * call the next span is measured by the wall clock even if it is long. */
void meter_base(struct meter *meter);

/* Returns the nanoseconds of work since the last meter_read(), meter_skip() or meter_init(), 0 or
 * more; begins the next span. */
int64_t meter_read(struct meter *meter);

/* Discards the time since the last reading, and begins the next span. */
void meter_skip(struct meter *meter);

#endif
