/* Reports how a replay through a live service ended. */
#ifndef REPLAY_BUS_H
#define REPLAY_BUS_H

#include "answer_bus.h"

/* If not all queries were answered, reports on stderr why, and what to do. log: paths. */
void replay_bus_end(const struct tally_bus *bus, const struct answer_bus_options *options,
                    char *const *log);

#endif
