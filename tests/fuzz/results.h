/* What is checked of the bytes of results, whoever wrote them: a fuzzer, or the service. */
#ifndef RESULTS_H
#define RESULTS_H

#include "wire.h"

/* Read as a result of the type; *out is static, and good until the next call. NULL where the reader
 * refuses them. Checks that it accepts just what encoders write and wire.h says of results, that
 * every field is what lcm-gen's decoder says, and that written again it is the same bytes; where a
 * text was cut or had bytes replaced, that it reads as the same again. */
const struct pair_result *results_read_pair(const uint8_t *data, size_t size);
const struct scene_result *results_read_scene(const uint8_t *data, size_t size);

#endif
