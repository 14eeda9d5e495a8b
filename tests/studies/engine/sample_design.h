// A protocol with one toggle block of given factors, as text made on the spot; and the two rating blocks around
// it.
#ifndef TESTS_STUDIES_SAMPLE_DESIGN_H
#define TESTS_STUDIES_SAMPLE_DESIGN_H

#include "studies/protocol/protocol.h"
#include "tests/studies/protocol/sample_catalogue.h"

#include <stdio.h>
#include <string.h>

// design: lines of the block below its options, indented by two.
static inline struct protocol *sample_design(const char *scenes, const char *design, char *error,
                                             size_t error_size)
{
    char text[4096];
    snprintf(text, sizeof text,
             "fovstudy: 1\nname: sample\ntitle: t\nseed: 0\nscenes: %s\n"
             "options: {f: {mode: time_warped, epsilon: 0.1}, r: {mode: regular}}\nreference: r\n"
             "questions: {q: {text: Which?}, z: {text: How?, scale: [1, 10]}, n: {text: How many?, count: [0, "
             "9]}}\ninstructions: i\n"
             "consent: {version: 1, text: c}\nsettings: {question: q}\n"
             "blocks:\n"
             "- {name: before, kind: rate, options: [f, r], settings: {question: z}}\n"
             "- name: main\n  kind: toggle\n  options: [f, r]\n%s"
             "- {name: after, kind: rate, options: [f, r], complement_of: before, settings: {question: z}}\n",
             scenes, design);
    return protocol_parse("sample", text, strlen(text), sample_catalogue(), error, error_size);
}

#define SAMPLE_NINE "  factors: {epsilon: [0.2, 0.1, 0.05], fovea_deg: [17, 10, 6]}\n"

#endif
