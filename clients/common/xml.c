#include "xml.h"

#include "allocate.h"

#include <expat.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#if XML_MAJOR_VERSION == 2 && XML_MINOR_VERSION < 9
#define XML_GetCurrentLineNumber64 XML_GetCurrentLineNumber /* which later versions deprecate */
#define XML_GetCurrentByteIndex64 XML_GetCurrentByteIndex
#define XML_GetCurrentByteCount64 XML_GetCurrentByteCount
#endif

struct parse {
    XML_Parser xml;
    const unsigned char *bytes;
    size_t size, count; /* count: of elements */
    struct owned_scene *memory;
    struct xml_element *root, *at; /* at: the open element */
    struct xml_error *error;
};

static const unsigned char *position(const struct parse *parse)
{
    const int64_t index = XML_GetCurrentByteIndex64(parse->xml);
    return parse->bytes +
           (index >= 0 && (size_t) index < parse->size ? (size_t) index : parse->size);
}

/* Sets the error, if it is the first one, and stops the parser. */
static void stop(struct parse *parse, const char *why, const char *remedy)
{
    struct xml_error *error = parse->error;
    if (*error->text)
        return;
    error->line = XML_GetCurrentLineNumber64(parse->xml);
    error->at = position(parse);
    snprintf(error->text, sizeof error->text, "%s: %s", why, remedy);
    XML_StopParser(parse->xml, XML_FALSE);
}

static void XMLCALL on_begin(void *user, const XML_Char *name, const XML_Char **attributes)
{
    enum { ELEMENTS_MAX = 1 << 20 };
    struct parse *parse = user;
    struct xml_element *parent = parse->at;
    size_t count = 0, size = strlen(name) + 1;
    if (++parse->count > ELEMENTS_MAX)
        stop(parse, "XML", "more than a million elements");
    if (*parse->error->text)
        return;
    for (; attributes[count]; count++)
        size += strlen(attributes[count]) + 1;
    size += sizeof(struct xml_element) + (count + 1) * sizeof(char *);
    struct xml_element *element = scene_alloc(parse->memory, 1, size);
    element->attributes = (const char **) (element + 1);
    element->name = (char *) (element->attributes + count + 1);
    char *next = stpcpy((char *) element->name, name) + 1;
    for (size_t i = 0; i < count; i++) {
        element->attributes[i] = next;
        next = stpcpy(next, attributes[i]) + 1;
    }
    element->line = XML_GetCurrentLineNumber64(parse->xml);
    element->begin = position(parse);
    element->text = element->text_end = element->begin + XML_GetCurrentByteCount64(parse->xml);
    element->parent = parent;
    if (parent && !parent->child)
        parent->text_end = element->begin;
    *(!parent ? &parse->root : parent->last ? &parent->last->next : &parent->child) = element;
    if (parent)
        parent->last = element;
    parse->at = element;
}

static void XMLCALL on_end(void *user, const XML_Char *name)
{
    struct parse *parse = user;
    (void) name;
    if (*parse->error->text)
        return;
    parse->at->end = position(parse);
    if (!parse->at->child)
        parse->at->text_end = parse->at->end;
    parse->at = parse->at->parent;
}

static void XMLCALL on_doctype(void *user, const XML_Char *name, const XML_Char *system,
                               const XML_Char *public, int internal)
{
    (void) name, (void) system, (void) public, (void) internal;
    stop(user, "<!DOCTYPE>",
         "document types and entities are not supported: remove the declaration");
}

/* What to do about errors whose text in Expat does not say it. */
static const char *remedy(enum XML_Error error)
{
    switch (error) {
    case XML_ERROR_XML_DECL: return ": write <?xml version=\"1.0\"?>";
    case XML_ERROR_UNKNOWN_ENCODING: return ": save the file as UTF-8, and say so in <?xml ...?>";
    case XML_ERROR_INVALID_TOKEN:
        return ": a stray < or &, no space before an attribute, or text that is not UTF-8";
    case XML_ERROR_NO_ELEMENTS: return ": the file ends too early";
    default: return "";
    }
}

/* Returns a copy of a file with spaces in place of comments and of instructions, <? ?>, other than
 * at the start. Thus "--" and any bytes are accepted in comments, and comments before <?xml ?>, as
 * by the parsers of ROS, which files of robots rely on. The caller frees it. */
static char *without_comments(const unsigned char *bytes, size_t size)
{
    enum { COMMENT, INSTRUCTION, CDATA, OTHER };
    static const char *const marks[][2] = {
        {"<!--", "-->"}, {"<?", "?>"}, {"<![CDATA[", "]]>"}, {"<", ""}};
    char *copy = allocate(size + 1, 1), *at, *end;
    memcpy(copy, bytes, size);
    const char *first = copy + strspn(copy, "\xef\xbb\xbf");
    for (at = copy; (at = memchr(at, '<', size - (size_t) (at - copy))); at = end) {
        int kind = COMMENT;
        while (strncmp(at, marks[kind][0], strlen(marks[kind][0])) != 0)
            kind++;
        if (!(end = strstr(at + strlen(marks[kind][0]), marks[kind][1])))
            break;
        end += strlen(marks[kind][1]);
        if (kind == COMMENT || (kind == INSTRUCTION && at != first))
            for (; at < end; at++)
                *at = *at == '\n' ? '\n' : ' ';
    }
    return copy;
}

struct xml_element *xml_parse(const unsigned char *bytes, size_t size, struct owned_scene *memory,
                              struct xml_error *error)
{
    struct parse parse = {.xml = XML_ParserCreate(NULL),
                          .bytes = bytes,
                          .size = size,
                          .memory = memory,
                          .error = error};
    char text[sizeof error->text], *copy = without_comments(bytes, size);
    if (!parse.xml)
        allocate_failed();
    *error->text = '\0';
    XML_SetUserData(parse.xml, &parse);
    XML_SetElementHandler(parse.xml, on_begin, on_end);
    XML_SetStartDoctypeDeclHandler(parse.xml, on_doctype);
    if (XML_Parse(parse.xml, copy, (int) size, XML_TRUE) != XML_STATUS_OK) {
        const enum XML_Error code = XML_GetErrorCode(parse.xml);
        snprintf(text, sizeof text, "%s%s", XML_ErrorString(code), remedy(code));
        stop(&parse, "XML", text);
    }
    XML_ParserFree(parse.xml);
    free(copy);
    return *error->text ? NULL : parse.root;
}

bool xml_is(const struct xml_element *element, const char *name)
{
    return strcmp(element->name, name) == 0;
}

struct xml_element *xml_next(const struct xml_element *element)
{
    if (element->child)
        return element->child;
    while (element && !element->next)
        element = element->parent;
    return element ? element->next : NULL;
}

struct xml_element *xml_child(const struct xml_element *parent, const char *name)
{
    struct xml_element *child = parent ? parent->child : NULL;
    while (child && !xml_is(child, name))
        child = child->next;
    return child;
}

const char *xml_attribute(const struct xml_element *element, const char *name)
{
    const char *const *at = element->attributes;
    while (*at && strcmp(at[0], name) != 0)
        at += 2;
    return *at ? at[1] : NULL;
}
