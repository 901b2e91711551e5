/* A log in memory, read in pieces of any size, with limits so small that small inputs meet them
 * all: this file's object takes the place of log_read.o. */
#ifndef LOG_PIECES_H
#define LOG_PIECES_H

#include <stddef.h>
#include <stdint.h>

/* In place of LOG_CHANNEL_MAX and LOG_DATA_MAX, and of the reader's buffer. */
enum { PIECES_CHANNEL_MAX = 8, PIECES_DATA_MAX = 16, PIECES_BUFFER_BYTES = 96 };

/* Zeros from a multiple of it on, so many, are a hole of the file. */
enum { PIECES_BLOCK = 8 };

/* What the next log_open() opens, whatever its path: the bytes, which the caller keeps, at most
 * piece of them at a time. piece > 0. */
void log_pieces_begin(const uint8_t *bytes, size_t size, size_t piece);

/* The file becomes so short. */
void log_pieces_shorten(size_t size);

#endif
