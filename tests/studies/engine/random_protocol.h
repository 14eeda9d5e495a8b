// Random protocols as text: factors of every kind, factors between people, every order, repetitions, listed
// trials, null and catch trials, several scenes, every kind of block.
#ifndef TESTS_STUDIES_RANDOM_PROTOCOL_H
#define TESTS_STUDIES_RANDOM_PROTOCOL_H

#include <stddef.h>
#include <stdint.h>

enum { RANDOM_PROTOCOL = 8192 }; // bytes that hold any of them

// The same text for the same seed. It can be read against sample_catalogue.
void random_protocol(uint32_t seed, char *out, size_t size);

#endif
