/* Escapes text in UTF-8 for JSON, XML, terminals and CSV. */
#ifndef ESCAPE_H
#define ESCAPE_H

#include <stddef.h>
#include <stdio.h>

/* ESCAPE_JSON: the inside of a JSON string, also where the JSON stands in a <script> of a page.
 * ESCAPE_XML: the text of an element, or of an attribute in double quotes; of XML, HTML and SVG.
 * ESCAPE_TERMINAL: a part of a line for people; control characters become \xNN, line separators and
 * marks of bidirectional text \uNNNN.
 * ESCAPE_CSV: the inside of a quoted field; as a line for people, with quotes doubled. */
enum escape { ESCAPE_JSON, ESCAPE_XML, ESCAPE_TERMINAL, ESCAPE_CSV };

/* Writes `size` bytes of UTF-8; each byte that is not part of valid UTF-8 becomes U+FFFD. JSON is
 * written in printable ASCII. In XML, characters that ESCAPE_TERMINAL escapes become U+FFFD too. */
void escape(FILE *out, enum escape form, const char *text, size_t size);

/* Writes a text in the form ESCAPE_TERMINAL. */
void escape_text(FILE *out, const char *text);

/* Returns the number of characters that ESCAPE_TERMINAL writes. */
size_t escape_characters(const char *text);

#endif
