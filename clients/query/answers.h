/* Answers all pairs of a scene, in their order: decides them in this process, or by the service on
 * the bus. With a margin, contacts and near pairs have a gap even if it is not wanted. A pair with
 * a body of several frames has its verdict, but no certificate.
 *
 * In process, fmb_decide() decides each pair, separated ones too. The service is queried for all
 * pairs as a list if gaps or certificates are wanted or the method is not certain; otherwise the
 * pairs that its results leave out are separated. */
#ifndef ANSWERS_H
#define ANSWERS_H

#include "args.h"
#include "scene.h"

void answers_local(struct owned_scene *scene, fmb_client_sink *sink, void *user);

struct answers_bus;

/* Opens the bus. timeout: seconds before a query is sent again; retries: how often. Never returns
 * NULL: if the bus cannot be opened (reported on stderr), or no service answers (reported once for
 * each outage, with advice), each pair of a scene gets an error. */
struct answers_bus *answers_bus_open(const struct args_bus *bus, double timeout, int retries);
void answers_bus_close(struct answers_bus *answers);

/* Returns false if later scenes need not be queried: there is no bus; or no service has answered or
 * sent a heartbeat since the bus was opened. */
bool answers_bus_scene(struct answers_bus *answers, struct owned_scene *scene,
                       fmb_client_sink *sink, void *user);

/* Whether both bodies of a pair have one frame: others have no certificate. */
bool pair_is_certified(const struct fmb_scene *scene, const unsigned pair[2]);

enum { VERIFY_TEXT_MAX = 256 };

/* Checks the certificate of an answer against the numbers of the scene, so that the verdict need
 * not be trusted. If there is none or it does not hold, the answer becomes an error, which is
 * written into text. whose: "the" or "the service's", for that error. */
void verify_answer(const struct fmb_scene *scene, const char *whose,
                   struct fmb_client_answer *answer, char text[VERIFY_TEXT_MAX]);

#endif
