/* Answers a query at once, from a struct: writes the message, answers it, and reads the result. */
#ifndef ANSWER_NOW_H
#define ANSWER_NOW_H

#include "answer.h"

/* The certificate is valid until the next call. */
void answer_pair(struct answerer *answerer, const struct pair_query *query,
                 struct pair_result *result);

/* Refusals without a check. */
void answer_pair_refused(struct answerer *answerer, const struct pair_query *query,
                         enum fmb_status status, struct pair_result *result);
void answer_scene_refused(struct answerer *answerer, const struct query_header *header,
                          enum fmb_status status, struct scene_result *result);
void answer_definition_refused(struct answerer *answerer, const struct query_header *header,
                               enum fmb_status status, struct definition *result);

#endif
