#include "question.h"

#include <stdio.h>
#include <string.h>

int solid_count(const struct solid *solid)
{
    return solid->shape == FMB_FACE ? 2 : solid->dim;
}

static void fill_body(const struct solid *solid, struct fmb_body *body)
{
    memset(body, 0, sizeof *body);
    body->dim = solid->dim;
    body->shape = solid->shape;
    body->count = solid_count(solid);
    memcpy(body->component, solid->component, sizeof body->component);
}

static void fill_frame(const struct solid *solid, const struct fmb_body *body,
                       struct fmb_frame *frame)
{
    frame->body = body;
    memcpy(frame->origin, solid->origin, sizeof frame->origin);
    memcpy(frame->velocity, solid->velocity, sizeof frame->velocity);
    frame->moving = solid->moving;
}

void question_pair(const struct question *question, struct fmb_body body[2], struct fmb_pair *pair)
{
    fill_body(&question->a, &body[0]);
    fill_body(&question->b, &body[1]);
    fill_frame(&question->a, &body[0], &pair->a);
    fill_frame(&question->b, &body[1], &pair->b);
    pair->duration = question->duration;
}

struct question question_swapped(const struct question *question)
{
    struct question swapped = *question;
    swapped.a = question->b;
    swapped.b = question->a;
    return swapped;
}

enum fmb_shape question_draw_shape(struct draw *draw, int dim)
{
    return (enum fmb_shape) draw_int(draw, FMB_CUBOID, dim == 3 ? FMB_FACE : FMB_TETRAHEDRON);
}

void question_draw_movers(struct draw *draw, struct question *question)
{
    const int who = draw_int(draw, 0, 3);
    question->a.moving = who & 1;
    question->b.moving = who & 2;
}

static void print_vector(const double *number)
{
    printf("{%a, %a, %a}", number[0], number[1], number[2]);
}

static void print_solid(const char *name, const struct solid *solid)
{
    static const char *const shapes[] = {"0", "FMB_CUBOID", "FMB_TETRAHEDRON", "FMB_FACE"};
    printf("#   .%s = {%d, %s, {", name, solid->dim, shapes[solid->shape]);
    for (int i = 0; i < FMB_DIM_MAX; i++) {
        print_vector(solid->component[i]);
        printf("%s", i + 1 < FMB_DIM_MAX ? ", " : "},\n#      ");
    }
    print_vector(solid->origin);
    printf(", ");
    print_vector(solid->velocity);
    printf(", %s},\n", solid->moving ? "true" : "false");
}

void question_print(const struct question *question)
{
    printf("# struct question question = {\n");
    print_solid("a", &question->a);
    print_solid("b", &question->b);
    printf("#   .duration = %a};\n", question->duration);
    fflush(stdout);
}
