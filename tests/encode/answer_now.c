#include "answer_now.h"

#include "wire.h"

#include <stdlib.h>

static unsigned char message[QUERY_BYTES_MAX], written[QUERY_BYTES_MAX];

static void require(bool holds)
{
    if (!holds)
        abort();
}

void answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result)
{
    static struct answer_job *job;
    if (!job)
        job = answer_job_create();
    require(job);
    require(!answer_job_begin(job, ANSWER_PAIR, message, wire_write_pair_query(query, message)));
    while (!answer_job_step(job, answerer))
        continue;
    *result = *answer_job_pair_result(job);
}

static uint32_t refuse(struct answerer *answerer, enum answer_kind kind, size_t size,
                       enum fmb_status status)
{
    size_t out = 0;
    require(!answer_refused(answerer, kind, message, size, status, written, &out));
    return (uint32_t) out;
}

void answer_pair_refused(struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result)
{
    const size_t size = wire_write_pair_query(query, message);
    require(!wire_read_pair_result(written, refuse(answerer, ANSWER_PAIR, size, status), result));
}

void answer_scene_refused(struct answerer *answerer, const struct query_header *header,
                          enum fmb_status status, struct scene_result *result)
{
    static struct scene_query query;
    query.header = *header;
    const size_t size = wire_write_scene_query(&query, message);
    require(!wire_read_scene_result(written, refuse(answerer, ANSWER_SCENE, size, status), result));
}

void answer_definition_refused(struct answerer *answerer, const struct query_header *header,
                               enum fmb_status status, struct definition *result)
{
    static struct definition_query query;
    query.header = *header;
    const size_t size = wire_write_definition_query(&query, message);
    require(
        !wire_read_definition(written, refuse(answerer, ANSWER_DEFINITION, size, status), result));
}
