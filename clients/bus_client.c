#include "bus_client.h"

#include "bus.h"
#include "complain.h"
#include "filter.h"
#include "wire.h"

/* What others ask would come to LCM too, to be read and thrown away: beside a flood of it a result
 * would find no room. This process has no other threads that open sockets, so that those of LCM are
 * known. Where the system takes no filter it works all the same. */
static void keep_out_others(const struct filter_others *before, const char *prefix)
{
    static const char *const name[] = {WIRE_PAIR_RESULT, WIRE_SCENE_RESULT, WIRE_STATUS};
    enum { CHANNELS = sizeof name / sizeof *name };
    char channel[CHANNELS][BUS_CHANNEL_MAX];
    const char *channels[CHANNELS];
    for (int i = 0; i < CHANNELS; i++) {
        bus_channel(channel[i], prefix ? prefix : "", name[i]);
        channels[i] = channel[i];
    }
    filter_attach(before, channels, CHANNELS);
}

struct fmb_client *bus_client_open(const struct args_bus *bus, struct fmb_client_options options)
{
    struct filter_others others;
    char why[FMB_CLIENT_WHY_MAX];
    options.url = bus->url;
    options.prefix = bus->prefix;
    filter_note_others(&others);
    struct fmb_client *client = fmb_client_open(&options, why, sizeof why);
    if (client)
        keep_out_others(&others, bus->prefix);
    else
        complain(why);
    return client;
}
