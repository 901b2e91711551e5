#include "urdf_reader.h"

#include "allocate.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* Reads a file, or its first bytes if it has more than ROBOT_BYTES_MAX. Check ferror(). */
static unsigned char *read_bytes(FILE *file, struct owned_scene *memory, size_t *size)
{
    unsigned char *bytes = NULL;
    size_t capacity = 0;
    *size = 0;
    while (!feof(file) && !ferror(file) && *size <= ROBOT_BYTES_MAX) {
        bytes = allocate_grow(bytes, &capacity, *size + BUFSIZ, 1);
        *size += fread(bytes + *size, 1, capacity - *size, file);
    }
    unsigned char *out = scene_alloc(memory, *size, 1);
    if (*size > 0)
        memcpy(out, bytes, *size);
    free(bytes);
    return out;
}

const struct xml_element *urdf_open(struct robot *robot, const char *path)
{
    const bool named = strcmp(path, "-") != 0;
    FILE *file = named ? fopen(path, "r") : stdin;
    size_t size = 0;
    unsigned char *bytes = file ? read_bytes(file, &robot->memory, &size) : NULL;
    const char *why = !file || ferror(file)    ? strerror(errno)
                      : size > ROBOT_BYTES_MAX ? "more than 8 MB"
                                               : NULL;
    struct xml_error error;
    robot->file = named ? path : "standard input";
    robot_begin(robot, NULL, NULL);
    if (named && file)
        fclose(file);
    if (why) {
        robot_say(&robot->errors, "%s: %s", robot->file, why);
        robot->bad = true;
        return NULL;
    }
    const struct xml_element *root = xml_parse(bytes, size, &robot->memory, &error);
    if (!root)
        robot_refuse(robot, error.line, "%s", error.text);
    for (const struct xml_element *at = root; at; at = xml_next(at))
        if (strncmp(at->name, "xacro:", 6) == 0)
            robot_refuse(robot, at->line, "<%.64s>: expand the file with xacro first", at->name);
    return robot->failed ? NULL : root;
}

const struct xml_element *urdf_child(struct robot *robot, const struct xml_element *parent,
                                     const char *name)
{
    const struct xml_element *found = xml_child(parent, name);
    for (const struct xml_element *other = found ? found->next : NULL; other; other = other->next)
        if (xml_is(other, name))
            robot_refuse(robot, other->line, "there is a second <%s>", name);
    return found;
}

const char *urdf_attribute(struct robot *robot, const struct xml_element *element, const char *name,
                           bool required)
{
    const char *value = xml_attribute(element, name);
    if (!value && required)
        robot_refuse(robot, element->line, "<%s> has no %s", element->name, name);
    else if (value && !*value)
        robot_refuse(robot, element->line, "<%s>: %s is empty", element->name, name);
    else if (value && (strstr(value, "${") || strstr(value, "$(")))
        robot_refuse(robot, element->line, "<%s>: %s is '%.64s': expand the file with xacro first",
                     element->name, name, value);
    return value && *value ? value : NULL;
}
