#include "xml.h"

#include "allocate.h"

#include <errno.h>
#include <expat.h>
#include <string.h>

#if XML_MAJOR_VERSION == 2 && XML_MINOR_VERSION < 9
#define XML_GetCurrentLineNumber64 XML_GetCurrentLineNumber /* which later versions deprecate */
#endif

void xml_refuse(struct xml_reader *reader, unsigned long line, const char *format, ...)
{
    va_list list;
    if (reader->failed)
        return;
    va_start(list, format);
    robot_refuse_list(reader->robot, reader->path, line, reader->kind, reader->within, format,
                      list);
    va_end(list);
    reader->failed = reader->bad = true;
}

/* ---- The tree ---- */

/* As xml_refuse(), and stops the parser. */
static void stop(struct xml_reader *reader, const char *name, const char *why)
{
    xml_refuse(reader, XML_GetCurrentLineNumber64(reader->xml), "<%.64s>: %s", name, why);
    XML_StopParser(reader->xml, XML_FALSE);
}

static void XMLCALL on_begin(void *user, const XML_Char *name, const XML_Char **attributes)
{
    struct xml_reader *reader = user;
    struct owned_scene *memory = &reader->robot->memory;
    struct xml_node *parent = reader->at, *node = scene_alloc(memory, 1, sizeof *node);
    size_t count = 0;
    while (attributes[count])
        count++;
    *node =
        (struct xml_node){.name = scene_text(memory, name),
                          .attributes = scene_alloc(memory, count + 1, sizeof *node->attributes),
                          .line = XML_GetCurrentLineNumber64(reader->xml),
                          .parent = parent};
    for (size_t i = 0; i < count; i++)
        node->attributes[i] = scene_text(memory, attributes[i]);
    *(parent->last ? &parent->last->next : &parent->child) = node;
    reader->at = parent->last = node;
    if (strncmp(name, "xacro:", 6) == 0)
        stop(reader, name, "expand the file with xacro first");
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    struct xml_reader *reader = user;
    (void) name;
    reader->at = reader->at->parent;
}

static void XMLCALL on_doctype(void *user, const XML_Char *name, const XML_Char *system,
                               const XML_Char *public, int internal)
{
    (void) name, (void) system, (void) public, (void) internal;
    stop(user, "!DOCTYPE", "document types and entities are not supported: remove the declaration");
}

/* What to do about errors whose text in Expat does not say it. */
static const char *xml_remedy(enum XML_Error error)
{
    switch (error) {
    case XML_ERROR_MISPLACED_XML_PI: return ": move <?xml ...?> to the start of the file";
    case XML_ERROR_XML_DECL: return ": write <?xml version=\"1.0\"?>";
    case XML_ERROR_UNKNOWN_ENCODING: return ": save the file as UTF-8, and say so in <?xml ...?>";
    case XML_ERROR_INVALID_TOKEN: return ": a stray < or &, or text that is not UTF-8";
    case XML_ERROR_NO_ELEMENTS: return ": the file ends too early";
    default: return "";
    }
}

static bool parse(struct xml_reader *reader, FILE *file)
{
    enum { PIECE = 1 << 16 };
    size_t bytes = 0, size;
    do {
        void *piece = XML_GetBuffer(reader->xml, PIECE);
        if (!piece)
            allocate_failed();
        size = fread(piece, 1, PIECE, file);
        bytes += size;
        if (ferror(file) || bytes > ROBOT_BYTES_MAX) {
            robot_say(&reader->robot->errors, "%s: %s", reader->path,
                      ferror(file) ? strerror(errno) : "more than 8 MB");
            return false;
        }
        if (XML_ParseBuffer(reader->xml, (int) size, size == 0) != XML_STATUS_OK) {
            const enum XML_Error error = XML_GetErrorCode(reader->xml);
            xml_refuse(reader, XML_GetCurrentLineNumber64(reader->xml), "XML: %s%s",
                       XML_ErrorString(error), xml_remedy(error));
        }
    } while (size > 0 && !reader->failed);
    return !reader->failed;
}

bool xml_read(struct xml_reader *reader, struct robot *robot, const char *path)
{
    const bool named = strcmp(path, "-") != 0;
    FILE *file = named ? fopen(path, "r") : stdin;
    *reader = (struct xml_reader){.robot = robot, .path = named ? path : "standard input"};
    reader->at = &reader->document;
    if (!file) {
        robot_say(&robot->errors, "%s: %s", path, strerror(errno));
        return false;
    }
    reader->xml = XML_ParserCreate(NULL);
    if (!reader->xml)
        allocate_failed();
    XML_SetUserData(reader->xml, reader);
    XML_SetElementHandler(reader->xml, on_begin, on_end);
    XML_SetStartDoctypeDeclHandler(reader->xml, on_doctype);
    const bool good = parse(reader, file);
    XML_ParserFree(reader->xml);
    if (named)
        fclose(file);
    return good;
}

/* ---- Elements and attributes ---- */

bool xml_is(const struct xml_node *node, const char *name)
{
    return strcmp(node->name, name) == 0;
}

const struct xml_node *xml_find_child(struct xml_reader *reader, const struct xml_node *parent,
                                      const char *name)
{
    const struct xml_node *found = NULL;
    for (const struct xml_node *node = parent->child; node; node = node->next) {
        if (xml_is(node, name) && found)
            xml_refuse(reader, node->line, "there is a second <%s>", name);
        found = xml_is(node, name) ? node : found;
    }
    return found;
}

const char *xml_find_attribute(struct xml_reader *reader, const struct xml_node *node,
                               const char *name, bool required)
{
    for (const char **at = node->attributes; *at; at += 2)
        if (strcmp(at[0], name) == 0) {
            if (!at[1])
                xml_refuse(reader, node->line, "<%s>: %s is empty", node->name, name);
            else if (strstr(at[1], "${") || strstr(at[1], "$("))
                xml_refuse(reader, node->line,
                           "<%s>: %s is '%.64s': expand the file with xacro first", node->name,
                           name, at[1]);
            return at[1];
        }
    if (required)
        xml_refuse(reader, node->line, "<%s> has no %s", node->name, name);
    return NULL;
}
