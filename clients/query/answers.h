/* Answers all pairs of a scene, in their order: decides them in this process, or by the service on
 * the bus. */
#ifndef ANSWERS_H
#define ANSWERS_H

#include "args.h"
#include "report.h"

typedef void answers_sink(void *user, const struct scene *scene, const struct outcome *outcome);

struct answers_options {
    const struct fmb_method *method; /* NULL: the default, of this process or of the service */
    /* Wanted. gap: of all pairs; if the scene has a margin, contacts and near pairs have one
     * anyway. */
    bool box, gap, certificate;
};

void answers_local(const struct answers_options *options, const struct scene *scene,
                   answers_sink *sink, void *user);

struct answers_bus;

/* Opens the bus. timeout: seconds before a query is sent again; retries: how often. Never returns
 * NULL: if the bus cannot be opened (reported on stderr), or no service answers (reported once for
 * each outage, with advice), each pair of a scene gets an error. */
struct answers_bus *answers_bus_open(const struct args_bus *bus,
                                     const struct answers_options *options, double timeout,
                                     int retries);
void answers_bus_close(struct answers_bus *answers);

/* Returns false if later scenes need not be queried: there is no bus; or no service has answered or
 * sent a heartbeat since the bus was opened. */
bool answers_bus_scene(struct answers_bus *answers, const struct scene *scene, answers_sink *sink,
                       void *user);

enum { VERIFY_TEXT_MAX = 256 };

/* Checks the certificate of an outcome against the numbers of the scene, so that the verdict need
 * not be trusted. If there is none or it does not hold, the outcome loses its answer, and gets an
 * error, written into text. whose: "the" or "the service's", for that error. */
void verify_outcome(const struct scene *scene, const char *whose, struct outcome *outcome,
                    char text[VERIFY_TEXT_MAX]);

#endif
