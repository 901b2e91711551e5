#ifndef FMB_COUNTERS_H
#define FMB_COUNTERS_H

/* The counters of a heartbeat, except those of results; status_t.lcm defines them. */
#define FMB_COUNTERS(X) \
    X(uptime_us)        \
    X(receive_buffer)   \
    X(received)         \
    X(answered)         \
    X(unsent)           \
    X(expired)          \
    X(refusals_unsent)  \
    X(scenes)           \
    X(definitions)      \
    X(pairs)            \
    X(malformed)        \
    X(fragmented)       \
    X(foreign)          \
    X(dropped)          \
    X(waiting)          \
    X(most_waiting)     \
    X(bodies)           \
    X(frames)           \
    X(frame_capacity)   \
    X(ids)              \
    X(hits)             \
    X(misses)           \
    X(evictions)        \
    X(compute_p50_ns)   \
    X(compute_p99_ns)   \
    X(compute_max_ns)

#endif
