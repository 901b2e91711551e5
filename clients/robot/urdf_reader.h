/* Files of URDF and SRDF: their elements, and errors about them. */
#ifndef URDF_READER_H
#define URDF_READER_H

#include "robot.h"
#include "xml.h"

/* Reads a file of at most ROBOT_BYTES_MAX; "-" is standard input. Returns the outermost element,
 * which belongs to the robot; NULL after an error: the file cannot be read, is not XML, or is
 * xacro. */
const struct xml_element *urdf_open(struct robot *robot, const char *path);

/* Returns the only element of this name in a parent, or NULL. */
const struct xml_element *urdf_child(struct robot *robot, const struct xml_element *parent,
                                     const char *name);

/* Returns the value of an attribute; NULL if it is missing, which is an error if it is required. An
 * empty value and an expression of xacro are errors. */
const char *urdf_attribute(struct robot *robot, const struct xml_element *element, const char *name,
                           bool required);

#endif
