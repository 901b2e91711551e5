#include "seeds.h"

#include <stdbool.h>
#include <string.h>

/* ---- Logs, for the small buffers of log_pieces.h ---- */

static struct {
    unsigned char bytes[1024];
    size_t size;
} file;

static void log_bytes(const void *bytes, size_t size)
{
    memcpy(file.bytes + file.size, bytes, size);
    file.size += size;
}

/* Of lengths below 256. */
static void log_header(unsigned char channel, unsigned char data)
{
    const unsigned char header[28] = {
        0xed, 0xa1, 0xda, 0x01, [11] = 1, [19] = 2, [23] = channel, [27] = data};
    log_bytes(header, sizeof header);
}

static void log_event(const char *channel, unsigned char size)
{
    const char data[255] = "data";
    log_header((unsigned char) strlen(channel), size);
    log_bytes(channel, strlen(channel));
    log_bytes(data, size);
}

static void end_log(const char *name)
{
    seeds_write("event_log", name, file.bytes, file.size);
    file.size = 0;
}

static void write_broken_logs(void)
{
    log_event("A", 4);
    log_bytes("garbage", 7);
    log_event("B", 5);
    log_bytes("garbage that takes more than what is kept, and another line", 59);
    log_event("C", 6);
    end_log("garbage");
    log_event("A", 4);
    log_header(1, 20); /* within the buffer */
    log_event("B", 0);
    log_header(1, 99);
    log_event("B", 4);
    log_header(0, 4);
    log_event("C", 4);
    log_header(8, 4);
    log_bytes("TOO_LONGdata", 12);
    log_event("C", 4);
    log_header(1, 5);
    file.bytes[file.size - 4] = 0x80; /* a negative size */
    log_event("C", 4);
    log_header(1, 5);
    end_log("lies");
    static const char hole[200];
    log_event("A", 4);
    log_bytes(hole, sizeof hole);
    log_event("B", 4);
    end_log("hole");
}

void seeds_logs(void)
{
    end_log("empty");
    log_event("A", 0);
    log_event("LONGEST", 16);
    log_event("KEPT", 17);
    log_event("MORE", 100);
    log_event("LAST", 1);
    end_log("good");
    for (unsigned char size = 0; size < 17; size++) /* at all places of the buffer */
        log_event(&"CHANNEL"[size % 7], size);
    end_log("sizes");
    for (unsigned char size = 0; size < 17; size++) {
        log_event(&"CHANNEL"[size % 7], size);
        log_bytes("garbage that goes on", 1 + 3 * size % 20);
    }
    end_log("damages");
    log_header(1, 1 + 2 * 33);
    log_bytes("A", 1);
    log_event("B", 4);
    log_event("C", 4);
    log_bytes("x", 1);
    log_event("D", 4);
    end_log("nested");
    write_broken_logs();
}

/* ---- Meshes: a triangle or two in each format ---- */

static void mesh_bytes(const char *text)
{
    log_bytes(text, strlen(text));
}

static void end_mesh(const char *name)
{
    seeds_write("mesh", name, file.bytes, file.size);
    file.size = 0;
}

static void mesh_number(uint64_t bits, int size, bool big_endian)
{
    for (int i = 0; i < size; i++) {
        const unsigned char byte = (unsigned char) (bits >> 8 * (big_endian ? size - 1 - i : i));
        log_bytes(&byte, 1);
    }
}

static void mesh_float(float value, bool big_endian)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    mesh_number(bits, sizeof bits, big_endian);
}

static void write_ply_texts(void)
{
    mesh_bytes(
        "ply\nformat ascii 1.0\ncomment of a few\nelement vertex 4\nproperty float x\n"
        "property float y\nproperty float z\nproperty float confidence\nelement face 2\n"
        "property list uchar int vertex_indices\nend_header\n0 0 0 1\n1e308 -1e308 1e-3 nan\n"
        "0 1 0 0.5 \n+.5 0. 12345678901234567890 inf\n3 0 1 2\n3 3 2 1\n");
    end_mesh("ply-ascii");
    mesh_bytes(
        "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement face 1\r\nproperty uchar red\r\n"
        "property list uint8 uint32 vertex_index\r\nproperty list int8 float64 texcoord\r\n"
        "element vertex 3\r\nproperty int16 z\r\nproperty float32 x\r\nproperty double y\r\n"
        "element edge 2\r\nproperty int a\r\nelement empty 1000000\r\nend_header\r\n"
        "255 3 0 1 2 2 0.5 1\r\n3 1 2\r\n-3 1e308 1e-22\r\n0 9007199254740993 4.9e-324\r\n"
        "1\r\n2\r\n");
    end_mesh("ply-order");
    mesh_bytes("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n");
    end_mesh("ply-empty");
}

static void write_ply_binaries(bool big_endian)
{
    mesh_bytes("ply\nformat ");
    mesh_bytes(big_endian ? "binary_big_endian" : "binary_little_endian");
    mesh_bytes(
        " 1.0\nelement other 2\nproperty list ushort short a\nproperty char b\n"
        "element vertex 3\nproperty float x\nproperty int y\nproperty ushort z\n"
        "element face 2\nproperty list uchar uchar vertex_indices\n"
        "property list int float texcoord\nend_header\n");
    for (int i = 0; i < 2; i++) {
        mesh_number((uint64_t) i, 2, big_endian);
        mesh_number(0xfffe, 2 * i, big_endian);
        mesh_number(0x80, 1, big_endian);
    }
    for (int i = 0; i < 3; i++) {
        mesh_float((float) i / 3, big_endian);
        mesh_number((uint64_t) -i, 4, big_endian);
        mesh_number(60000, 2, big_endian);
    }
    for (int i = 0; i < 2; i++) {
        mesh_number(0x03000102, 4, true);
        mesh_number((uint64_t) i, 4, big_endian);
        mesh_number(0x7fc00000, 4 * i, big_endian);
    }
    end_mesh(big_endian ? "ply-be" : "ply-le");
}

static void write_ply_lists(void)
{
    mesh_bytes(
        "ply\nformat binary_big_endian 1.0\nelement a 9\nproperty list uchar ushort b\n"
        "end_header\n");
    for (int i = 0; i < 9; i++)
        mesh_number(0x012345, 3, true);
    end_mesh("ply-lists");
}

static void write_stls(void)
{
    static const char head[80] = "solid, and yet binary";
    mesh_bytes(
        "solid a name\n facet normal 0 0 nan\n  outer loop\n   vertex 0 0 0\n"
        "   vertex 1 0 0\n   vertex 0 1e308 -0\n  endloop\n endfacet\nFACET NORMAL 0 0 1 "
        "OUTER LOOP VERTEX 1 0 0 VERTEX 0 1 0 VERTEX 1 1 0 ENDLOOP ENDFACET\n"
        "endsolid a name\nsolid\nendsolid\n");
    end_mesh("stl-ascii");
    log_bytes(head, sizeof head);
    mesh_number(3, 4, false);
    for (int facet = 0; facet < 3; facet++) {
        for (int number = 0; number < 12; number++)
            mesh_float((float) (number * facet % 5) / -4, false);
        mesh_number(0x7fff, 2, false);
    }
    end_mesh("stl-binary");
}

static void write_objs(void)
{
    mesh_bytes(
        "# a mesh\nmtllib a.mtl\no a\nv 0 0 0\nv 1 0 0 1\nv 0 1 0 0.5 0.5 0.5\n"
        "v 1 \\\n 1 \\\r\n 0 1 1 1 1 # of seven\nvt 0 0\nvn 0 0 1\ng\ns off\nusemtl b\n"
        "f 1 2 3\nf 4/1 3/1 2/1\nf 1//1 2//1 4//1\nf -4/1/1 -1/1/1 \\\n-2/-1/-1\n"
        "f 5 1 2\nv -1e308 .5 5.\nl 1 2\np 1\ncstype bezier\n");
    end_mesh("obj");
}

void seeds_meshes(void)
{
    write_ply_texts();
    write_ply_binaries(false);
    write_ply_binaries(true);
    write_ply_lists();
    write_stls();
    write_objs();
}

/* ---- Robots: URDF, a table, and a mesh that its file calls "102" ---- */

static void end_robot(const char *name)
{
    seeds_write("robot_files", name, file.bytes, file.size);
    file.size = 0;
}

void seeds_robots(void)
{
    mesh_bytes(
        "<robot><link name='a'><collision><geometry><box size='1 2 3'/></geometry></collision>"
        "<collision><origin xyz='1 0 0' rpy='0 0 1'/><geometry><box size='1 1 1'/></geometry>"
        "</collision></link><link name='b'><collision><geometry><sphere radius='.5'/></geometry>"
        "</collision></link><joint name='j' type='revolute'><origin xyz='0 0 1'/><parent link='a'/>"
        "<child link='b'/><axis xyz='0 1 1'/><limit lower='-1' upper='1e308'/></joint></robot>");
    log_bytes("", 1);
    mesh_bytes("j,time,label\n0.5,0,start\n2,1.5,\"a \"\"b\"\"\"\n");
    end_robot("arm");
    mesh_bytes(
        "<robot><joint name='s' type='prismatic'><parent link='b'/><child link='a'/>"
        "<limit upper='1'/></joint><link name='a'><collision><geometry>"
        "<mesh filename='102' scale='1 -1 2'/></geometry></collision></link><link name='b'/>"
        "<link name='c'><collision><geometry><cylinder radius='1' length='2'/></geometry>"
        "</collision></link><joint name='f' type='continuous'><parent link='a'/><child link='c'/>"
        "<mimic joint='s' multiplier='-2' offset='.5'/></joint></robot>");
    log_bytes("", 1);
    mesh_bytes("\xef\xbb\xbf s \r\n1\r\n");
    log_bytes("", 1);
    mesh_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no a\nf 1 2 3\no b\nf -1 -2 -3\nf 1 2 4\n");
    end_robot("mesh");
    mesh_bytes(
        "<robot><link name='a'><collision><geometry><mesh filename='102'/></geometry>"
        "</collision></link></robot>");
    log_bytes("", 1);
    mesh_bytes("time\n1e308\n");
    log_bytes("", 1);
    mesh_bytes(
        "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
        "vertex 0 1 0\nendloop\nendfacet\nendsolid\n");
    end_robot("stl");
    mesh_bytes(
        "<robot xmlns:e='e'><link name='a'><collision><geometry><e:x/><sphere radius='1'/>"
        "</geometry></collision></link><link name='b'/><joint name='j' type='revolute'>"
        "<parent link='a'/><child link='b'/><limit upper='1'/></joint></robot>");
    log_bytes("", 1);
    mesh_bytes("j\n1.0009\n90\n");
    end_robot("outside");
}
