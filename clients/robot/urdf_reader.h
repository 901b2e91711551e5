/* Files of URDF and SRDF: their elements, and errors about them. Bytes are bounded (robot.h). */
#ifndef URDF_READER_H
#define URDF_READER_H

#include "robot.h"
#include "xml.h"

struct urdf_reader {
    struct robot *robot; /* owns the tree of elements, and has the errors */
    const char *path;
    struct xml_element *root;
    const char *kind, *within; /* of robot_refuse(): what is being read */
    /* Only the first error of an element is reported: further errors are dropped until the caller
     * sets failed to false. Results are not used while it is true. bad: there was an error. */
    bool failed, bad;
};

/* Reads a file; "-" is standard input. Returns false after an error: the file cannot be read, is
 * not XML, or is xacro. */
bool urdf_open(struct urdf_reader *reader, struct robot *robot, const char *path);

__attribute__((format(printf, 3, 4))) void urdf_refuse(struct urdf_reader *reader,
                                                       const struct xml_element *at,
                                                       const char *format, ...);

/* Returns the only element of this name in a parent, or NULL. */
const struct xml_element *urdf_child(struct urdf_reader *reader, const struct xml_element *parent,
                                     const char *name);

/* Returns the value of an attribute; NULL if it is missing, which is an error if it is required. An
 * empty value and an expression of xacro are errors. */
const char *urdf_attribute(struct urdf_reader *reader, const struct xml_element *element,
                           const char *name, bool required);

#endif
