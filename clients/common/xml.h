/* A file of XML as a tree of elements, by Expat.
 *
 * Files are not trusted. A document type declaration is refused, so that entities are neither
 * declared nor loaded, and nothing expands. Elements are bounded; nothing recurses. */
#ifndef XML_H
#define XML_H

#include "keyed_hash.h"
#include "scene.h"

struct xml_element {
    const char *name;
    const char **attributes; /* name, value, ..., NULL */
    unsigned long line;
    const unsigned char *begin, *end;                 /* of all of it, in the file */
    const unsigned char *text, *text_end;             /* its text, before the first child */
    struct xml_element *parent, *child, *last, *next; /* first and last child; next sibling */
    /* Of the caller: an entry of a table, and marks; 0 at first. */
    UT_hash_handle hh;
    bool repeated, open;
};

struct xml_error {
    unsigned long line;
    const unsigned char *at;
    char text[192];
};

/* Parses a file in memory, at most INT_MAX bytes, which has to outlive the tree. memory: receives
 * the tree. Returns the outermost element; NULL after an error. */
struct xml_element *xml_parse(const unsigned char *bytes, size_t size, struct owned_scene *memory,
                              struct xml_error *error);

bool xml_is(const struct xml_element *element, const char *name);

/* Returns the next element in the order of the file; NULL: there is none. */
struct xml_element *xml_next(const struct xml_element *element);

/* Returns the first child of a name; NULL: there is none, or no parent. */
struct xml_element *xml_child(const struct xml_element *parent, const char *name);

/* Returns the value of an attribute; NULL: there is none. */
const char *xml_attribute(const struct xml_element *element, const char *name);

#endif
