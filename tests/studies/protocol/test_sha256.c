// The examples of FIPS 180-4 (NIST "SHA256" example file and CAVP short messages) and the padding's every edge.
#include "studies/protocol/sha256.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void expect(const void *data, size_t size, const char *wanted)
{
    uint8_t digest[SHA256_BYTES];
    char hex[SHA256_HEX];
    sha256(data, size, digest);
    sha256_hex(digest, hex);
    assert_string_equal(hex, wanted);
}

static void test_published_examples(void **state)
{
    (void)state;
    expect("", 0, "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    expect("abc", 3, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    const char *two = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
    expect(two, strlen(two), "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    char *million = malloc(1000000);
    assert_non_null(million);
    memset(million, 'a', 1000000);
    expect(million, 1000000, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
    free(million);
}

// sha256sum of coreutils on 0..130 bytes 'x', its digests chained: every position of the padding.
static void test_every_padding(void **state)
{
    (void)state;
    char all[131 * (SHA256_HEX - 1)];
    char xs[130];
    memset(xs, 'x', sizeof xs);
    for (size_t size = 0; size <= 130; size++) {
        uint8_t digest[SHA256_BYTES];
        char hex[SHA256_HEX];
        sha256(xs, size, digest);
        sha256_hex(digest, hex);
        memcpy(all + size * (SHA256_HEX - 1), hex, SHA256_HEX - 1);
    }
    expect(all, sizeof all, "87aca1c44bc7ba8897768170211f0a02063de70801131ff86c7edb9ce32c6a50");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_published_examples),
        cmocka_unit_test(test_every_padding),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
