/* The calls that ask. */
#include "client.h"
#include "order.h"

#include <stdio.h>
#include <string.h>

const char *fmb_client_why(const struct fmb_client *client)
{
    return client->why;
}

/* A status of the whole question, in words. */
static int refuse(struct fmb_client *client, int status)
{
    snprintf(client->why, sizeof client->why, "%s", fmb_client_status_text(status));
    return status;
}

static int ask_parts(struct fmb_client *client, const struct fmb_client_scene *scene,
                     struct cut *cut, fmb_client_sink *sink, void *user)
{
    struct order order;
    if (!order_begin(cut, sink, user, &order))
        return refuse(client, FMB_CLIENT_NO_MEMORY);
    client->inside = true;
    asking_run(client, scene, cut, &order);
    client->inside = false;
    order_end(&order);
    return FMB_OK;
}

/* alone: by pair queries. */
static int ask(struct fmb_client *client, const struct fmb_client_scene *scene, bool alone,
               fmb_client_sink *sink, void *user)
{
    struct cut cut;
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    const int status = question_check(scene, client->why);
    if (status != FMB_OK)
        return status;
    if (client->failed || !client_subscribe(client, alone ? CLIENT_PAIRS : CLIENT_SCENES))
        return refuse(client, FMB_CLIENT_NO_BUS);
    if (!cut_begin(scene, alone, &cut))
        return refuse(client, FMB_CLIENT_NO_MEMORY);
    const int done = ask_parts(client, scene, &cut, sink, user);
    cut_end(&cut);
    return done;
}

int fmb_client_ask(struct fmb_client *client, const struct fmb_client_scene *scene,
                   fmb_client_sink *sink, void *user)
{
    return ask(client, scene, scene->want & FMB_CLIENT_WANT_CERTIFICATE, sink, user);
}

static void keep_answer(void *user, const struct fmb_client_answer *answer)
{
    struct fmb_client *client = user;
    client->answer = *answer;
    snprintf(client->text, sizeof client->text, "%s", answer->text);
    client->answer.text = client->text;
    if (answer->certificate)
        client->answer.certificate = strcpy(client->certificate, answer->certificate);
}

int fmb_client_ask_pair(struct fmb_client *client, const struct fmb_client_frame pair[2],
                        double duration, unsigned want, struct fmb_client_answer *out)
{
    static const unsigned both[1][2] = {{0, 1}};
    const struct fmb_client_scene scene = {.frames = pair,
                                           .frame_count = 2,
                                           .which = FMB_CLIENT_LISTED,
                                           .pairs = both,
                                           .pair_count = 1,
                                           .duration = duration,
                                           .want = want};
    *out = (struct fmb_client_answer){.b = 1, .text = ""};
    out->status = ask(client, &scene, true, keep_answer, client);
    if (out->status == FMB_OK)
        *out = client->answer;
    else
        out->text =
            out->status == FMB_CLIENT_INSIDE ? fmb_client_status_text(out->status) : client->why;
    return out->status;
}
