#include "keyed_hash.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

static inline uint64_t rotate(uint64_t value, int bits)
{
    return value << bits | value >> (64 - bits);
}

static inline void mix(uint64_t v[4])
{
    v[0] += v[1], v[1] = rotate(v[1], 13) ^ v[0], v[0] = rotate(v[0], 32);
    v[2] += v[3], v[3] = rotate(v[3], 16) ^ v[2];
    v[0] += v[3], v[3] = rotate(v[3], 21) ^ v[0];
    v[2] += v[1], v[1] = rotate(v[1], 17) ^ v[2], v[2] = rotate(v[2], 32);
}

static inline void add_word(uint64_t v[4], uint64_t word)
{
    v[3] ^= word;
    mix(v);
    v[0] ^= word;
}

/* J.-P. Aumasson, D. J. Bernstein: SipHash: a fast short-input PRF, 2012; one round a word and
 * three at the end, as in the tables of several languages. */
unsigned keyed_hash_of(const uint64_t secret[2], const void *key, size_t size)
{
    const unsigned char *at = key;
    uint64_t word, v[4] = {
                       secret[0] ^ UINT64_C(0x736f6d6570736575),
                       secret[1] ^ UINT64_C(0x646f72616e646f6d),
                       secret[0] ^ UINT64_C(0x6c7967656e657261),
                       secret[1] ^ UINT64_C(0x7465646279746573),
                   };
    size_t left = size;
    for (; left >= sizeof word; left -= sizeof word, at += sizeof word) {
        memcpy(&word, at, sizeof word);
        add_word(v, word);
    }
    word = 0;
    memcpy(&word, at, left);
    add_word(v, word | (uint64_t) size << 56);
    v[2] ^= 0xff;
    for (int i = 0; i < 3; i++)
        mix(v);
    return (unsigned) (v[0] ^ v[1] ^ v[2] ^ v[3]);
}

static uint64_t secret[2];

static void make_secret(void)
{
    if (getrandom(secret, sizeof secret, 0) != (ssize_t) sizeof secret)
        abort(); /* not on a kernel that has the call */
}

unsigned keyed_hash_value(const void *key, size_t size)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_secret);
    return keyed_hash_of(secret, key, size);
}
