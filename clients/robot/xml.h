/* XML files of robots: Expat's events become a tree of elements.
 *
 * Files are not trusted. A document type declaration is refused, so that entities are neither
 * declared nor loaded, and nothing expands. Bytes are bounded (robot.h); nothing recurses. */
#ifndef XML_H
#define XML_H

#include "robot.h"

struct xml_node {
    const char *name;
    const char **attributes; /* name, value (NULL: ""), ..., NULL */
    unsigned long line;
    struct xml_node *parent, *child, *last, *next; /* first and last child; next sibling */
};

struct xml_reader {
    struct robot *robot; /* owns the tree, and has the errors */
    const char *path;
    struct xml_node document, *at; /* at: the open element */
    const char *kind, *within;     /* of robot_refuse(): what is being read */
    /* Only the first error of an element is reported: further errors are dropped until the caller
     * sets failed to false. Results are not used while it is true. bad: there was an error. */
    bool failed, bad;
    struct XML_ParserStruct *xml; /* private */
};

/* Reads a file; "-" is standard input. On output: document.child is the outermost element. Returns
 * false after an error: the file cannot be read, or is not XML. */
bool xml_read(struct xml_reader *reader, struct robot *robot, const char *path);

__attribute__((format(printf, 3, 4))) void xml_refuse(struct xml_reader *reader, unsigned long line,
                                                      const char *format, ...);

bool xml_is(const struct xml_node *node, const char *name);

/* Returns the only element of this name in a parent, or NULL. */
const struct xml_node *xml_find_child(struct xml_reader *reader, const struct xml_node *parent,
                                      const char *name);

/* Returns the value of an attribute; NULL if it is missing, which is an error if it is required. An
 * empty value and an expression of xacro are errors. */
const char *xml_find_attribute(struct xml_reader *reader, const struct xml_node *node,
                               const char *name, bool required);

#endif
