#include "urdf_reader.h"

#include <errno.h>
#include <string.h>

void urdf_refuse(struct urdf_reader *reader, const struct xml_element *at, const char *format, ...)
{
    va_list list;
    if (reader->failed)
        return;
    va_start(list, format);
    robot_refuse_list(reader->robot, reader->path, at->line, reader->kind, reader->within, format,
                      list);
    va_end(list);
    reader->failed = reader->bad = true;
}

bool urdf_open(struct urdf_reader *reader, struct robot *robot, const char *path)
{
    const bool named = strcmp(path, "-") != 0;
    FILE *file = named ? fopen(path, "r") : stdin;
    unsigned char *bytes = scene_alloc(&robot->memory, ROBOT_BYTES_MAX + 1, 1);
    const size_t size = file ? fread(bytes, 1, ROBOT_BYTES_MAX + 1, file) : 0;
    const char *why = !file || ferror(file)    ? strerror(errno)
                      : size > ROBOT_BYTES_MAX ? "more than 8 MB"
                                               : NULL;
    struct xml_error error;
    *reader = (struct urdf_reader){.robot = robot, .path = named ? path : "standard input"};
    if (named && file)
        fclose(file);
    if (why) {
        robot_say(&robot->errors, "%s: %s", reader->path, why);
        return false;
    }
    reader->root = xml_parse(bytes, size, &robot->memory, &error);
    if (!reader->root)
        urdf_refuse(reader, &(struct xml_element){.line = error.line}, "%s", error.text);
    for (const struct xml_element *at = reader->root; at; at = xml_next(at))
        if (strncmp(at->name, "xacro:", 6) == 0)
            urdf_refuse(reader, at, "<%.64s>: expand the file with xacro first", at->name);
    return !reader->failed;
}

const struct xml_element *urdf_child(struct urdf_reader *reader, const struct xml_element *parent,
                                     const char *name)
{
    const struct xml_element *found = xml_child(parent, name);
    for (const struct xml_element *other = found ? found->next : NULL; other; other = other->next)
        if (xml_is(other, name))
            urdf_refuse(reader, other, "there is a second <%s>", name);
    return found;
}

const char *urdf_attribute(struct urdf_reader *reader, const struct xml_element *element,
                           const char *name, bool required)
{
    const char *value = xml_attribute(element, name);
    if (!value && required)
        urdf_refuse(reader, element, "<%s> has no %s", element->name, name);
    else if (value && !*value)
        urdf_refuse(reader, element, "<%s>: %s is empty", element->name, name);
    else if (value && (strstr(value, "${") || strstr(value, "$(")))
        urdf_refuse(reader, element, "<%s>: %s is '%.64s': expand the file with xacro first",
                    element->name, name, value);
    return value && *value ? value : NULL;
}
