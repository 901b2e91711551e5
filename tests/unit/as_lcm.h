/* What the service writes, held against LCM's own code. */
#ifndef AS_LCM_H
#define AS_LCM_H

/* The generated code for the type reads a message of so many bytes, and writes of it the same. */
#define ASSERT_AS_LCM_WRITES(type, bytes, size)                                      \
    do {                                                                             \
        static unsigned char written[QUERY_BYTES_MAX];                               \
        type message;                                                                \
        assert_int_equal(type##_decode(bytes, 0, (int) (size), &message), size);     \
        assert_int_equal(type##_encode(written, 0, sizeof written, &message), size); \
        assert_memory_equal(written, bytes, size);                                   \
        type##_decode_cleanup(&message);                                             \
    } while (0)

#endif
