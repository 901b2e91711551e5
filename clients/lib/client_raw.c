#include "fmb_client_raw.h"

#include "client.h"
#include "clock.h"

#include <string.h>

bool fmb_client_raw_ready(const struct fmb_client *client, size_t bytes)
{
    return requests_ready(&client->requests, bytes);
}

/* The handler of raw requests. */
static enum request_taken deliver_raw(void *user, struct request *request,
                                      const struct request_result *result)
{
    const struct fmb_client_raw_result out = {result->status, result->bytes, result->size,
                                              request->query, request->size};
    request->raw_sink(user, &out);
    return REQUEST_COMPLETE;
}

int fmb_client_raw_send(struct fmb_client *client, enum fmb_client_kind kind,
                        const unsigned char *message, size_t size, size_t bytes,
                        fmb_client_raw_sink *sink, void *user)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    if (size > QUERY_BYTES_MAX)
        return FMB_OVER_LIMIT;
    if (size < REQUEST_IDS_END)
        return FMB_WRONG_COUNT;
    if (client->failed || !client_listen(client, (int) kind))
        return FMB_CLIENT_NO_BUS;
    client->inside = true;
    struct request *request = request_begin(&client->requests, kind, bytes, deliver_raw, user);
    request->raw_sink = sink;
    request->size = size;
    memcpy(request->query, message, size);
    request_send(&client->requests, request);
    client->inside = false;
    return FMB_OK;
}

int fmb_client_raw_step(struct fmb_client *client, int other_fd, double timeout)
{
    if (client->inside)
        return FMB_CLIENT_INSIDE;
    client->inside = true;
    requests_step(&client->requests, other_fd, clock_ns() + (int64_t) (1e9 * timeout));
    client->inside = false;
    return client->failed ? FMB_CLIENT_NO_BUS : client->requests.count;
}
