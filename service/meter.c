#include "meter.h"

#include "clock.h"

const struct meter_clocks meter_system_clocks = {clock_ns, clock_thread_ns};

void meter_init(struct meter *meter, const struct meter_clocks *clocks)
{
    *meter = (struct meter){.clocks = clocks, .wall_ns = clocks->wall_ns()};
}

static void set_base(struct meter *meter, int64_t cpu_ns)
{
    meter->based = true;
    meter->base_ns = cpu_ns;
    meter->metered_ns = 0;
}

void meter_base(struct meter *meter)
{
    if (!meter->based)
        set_base(meter, meter->clocks->cpu_ns());
}

int64_t meter_read(struct meter *meter)
{
    const int64_t wall_ns = meter->clocks->wall_ns();
    int64_t span_ns = wall_ns - meter->wall_ns;
    meter->wall_ns = wall_ns;
    if (span_ns > METER_TRUSTED_NS && meter->based) {
        const int64_t cpu_ns = meter->clocks->cpu_ns();
        const int64_t worked_ns = cpu_ns - meter->base_ns - meter->metered_ns;
        span_ns = worked_ns > 0 ? worked_ns : 0;
        set_base(meter, cpu_ns);
    } else {
        meter->metered_ns += span_ns;
    }
    return span_ns;
}

void meter_skip(struct meter *meter)
{
    meter->wall_ns = meter->clocks->wall_ns();
    meter->based = false;
}
