#include "replay_bus.h"

#include "args.h"
#include "number.h"

#include <inttypes.h>
#include <stdio.h>

static void report_never(const struct answer_bus_options *options, double patience)
{
    const struct args_bus where = {options->url, options->prefix};
    fprintf(stderr, "fmb: no fmbd answered on %sFMB_PAIR_RESULT and %sFMB_SCENE_RESULT of %s",
            options->prefix, options->prefix, args_bus_name(&where));
    fprintf(stderr, " within %g s\n", patience);
}

static void report_no_more(const struct tally_bus *bus, double patience, char *const *log)
{
    char answered[NUMBER_TEXT_MAX];
    fprintf(stderr, "fmb: fmbd answered %s queries, and then nothing for %g s; ",
            number_grouped(bus->answered, answered), patience);
    fprintf(stderr, "the next one is event %" PRId64 " (offset %" PRId64 ") of %s\n", bus->number,
            bus->offset, log[bus->log]);
}

/* No service has answered at all, or none does any more. */
static void report_no_service(const struct tally_bus *bus, const struct answer_bus_options *options,
                              char *const *log)
{
    const double patience = options->timeout * (options->retries + 1);
    if (bus->services == 0)
        report_never(options, patience);
    else
        report_no_more(bus, patience, log);
    if (bus->nonsense > 0)
        fprintf(stderr, "fmb: %" PRId64 " results could not be read: another version of fmbd?\n",
                bus->nonsense);
    fprintf(stderr,
            "fmb: start one with 'fmbd%s%s &', or replay in this process: leave out --bus\n",
            *options->prefix ? " --prefix " : "", options->prefix);
}

static void report_signal(const struct tally_bus *bus)
{
    char answered[NUMBER_TEXT_MAX];
    fprintf(stderr, "fmb: ended by a signal; counts are of %s queries, answered so far\n",
            number_grouped(bus->answered, answered));
}

void replay_bus_end(const struct tally_bus *bus, const struct answer_bus_options *options,
                    char *const *log)
{
    switch ((enum answer_bus_end) bus->end) {
    case ANSWER_BUS_NO_END: break;
    case ANSWER_BUS_SIGNAL: report_signal(bus); break;
    case ANSWER_BUS_NOBODY: report_no_service(bus, options, log); break;
    case ANSWER_BUS_FAILED: fputs("fmb: the bus has failed\n", stderr); break;
    }
}
