/* How a replay through a live service ended, for people. */
#ifndef REPLAY_BUS_H
#define REPLAY_BUS_H

#include "answer_bus.h"

/* Says on stderr why not all was asked, and what to do; nothing where all was. log: the paths. */
void replay_bus_end(const struct tally_bus *bus, const struct answer_bus_options *options,
                    char *const *log);

#endif
