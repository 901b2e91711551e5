#include "client.h"
#include "client_scene.h"

#include <stdio.h>
#include <string.h>

const char *fmb_client_why(const struct fmb_client *client)
{
    return client->why;
}

/* Sets the reason of a status of the whole scene. Returns the status. */
static int fail(struct fmb_client *client, int status)
{
    snprintf(client->why, sizeof client->why, "%s", fmb_client_status_text(status));
    return status;
}

/* single: each pair is a separate query. */
static int query(struct fmb_client *client, const struct fmb_scene *scene, bool single,
                 fmb_client_sink *sink, void *user)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    int status = client_scene_check(scene, client->why);
    if (status != FMB_OK)
        return status;
    if (client->failed || !client_listen(client, single ? FMB_CLIENT_PAIR : FMB_CLIENT_SCENE))
        return fail(client, FMB_CLIENT_NO_BUS);
    client->inside = true;
    status = scene_run(&client->run, scene, single, sink, user);
    client->inside = false;
    return status == FMB_OK ? status : fail(client, status);
}

int fmb_client_query(struct fmb_client *client, const struct fmb_scene *scene,
                     fmb_client_sink *sink, void *user)
{
    return query(client, scene, scene->want & FMB_WANT_CERTIFICATE, sink, user);
}

/* The sink of fmb_client_query_pair(): copies the answer and its texts into the client. */
static void keep_answer(void *user, const struct fmb_client_answer *answer)
{
    struct fmb_client *client = user;
    client->answer = *answer;
    snprintf(client->text, sizeof client->text, "%s", answer->text);
    client->answer.text = client->text;
    if (answer->certificate)
        client->answer.certificate = strcpy(client->certificate, answer->certificate);
}

int fmb_client_query_pair(struct fmb_client *client, const struct fmb_placement pair[2],
                          double duration, unsigned want, struct fmb_client_answer *out)
{
    struct fmb_placement placement[2] = {pair[0], pair[1]};
    placement[0].group = placement[1].group = 0;
    const bool ends = pair[0].end_count || pair[1].end_count;
    const struct fmb_scene scene = {.placements = placement,
                                    .placement_count = 2,
                                    .duration = duration,
                                    .instant = duration == 0 && !ends,
                                    .want = want};
    *out = (struct fmb_client_answer){.b = 1, .text = ""};
    out->status = query(client, &scene, true, keep_answer, client);
    if (out->status == FMB_OK)
        *out = client->answer;
    else
        out->text =
            out->status == FMB_CLIENT_INSIDE ? fmb_client_status_text(out->status) : client->why;
    return out->status;
}
