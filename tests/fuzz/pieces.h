/* The input of text.c in memory, handed out in pieces of any size: this file's object takes the
 * place of text.o. */
#ifndef PIECES_H
#define PIECES_H

#include <stddef.h>
#include <stdint.h>

/* What comes next: the bytes, which the caller keeps, at most piece at a time. piece > 0. */
void pieces_begin(const uint8_t *bytes, size_t size, size_t piece);

#endif
