//! Facts about Blosc's containers: what c-blosc 1.21 packed, in every way, and containers that are not what they say.

use proptest::prelude::*;

use super::*;

/// 400 numbers of 16 bits, 1001 more at every 25th, as numcodecs' `Blosc` packed them.
const PACKED: [(&str, &str); 8] = [
    (
        "blosclz",
        "020101022003000020030000c800000014000000560000002300000000e00c0300e9e00f0000d2e00f0000bbe00f0000a4e00f00008de00f000076e00f00005fe00f000048e00f000031e00f00001ae00f000003e00f0000ece00f0000d5e00f0000bee00f0000a7e00d0001a7a7560000002300000000e00c030003e00f000007e00f00000be00f00000fe00f000013e00f000017e00f00001be00f00001fe00f000023e00f000027e00f00002be00f00002ee00f000032e00f000036e00f00003ae00d00013a3a",
    ),
    (
        "blosclz, plain",
        "02010002200300002003000096000000140000003d0000002300000000e024030200e903e026010203d207e026010207bb0be02601020ba40fe02601020f8d13e0260102137617e0260102175f1be02401021b5f1b3d00000023481f481fe02403021f3123e0260102231a27e026010227032be02601022bec2ee02601022ed532e026010232be36e026010236a73ae02401023aa73a",
    ),
    (
        "lz4",
        "020121022003000020030000c800000014000000560000001f000100051fe90100051fd20100051fbb0100051fa40100051f8d0100051f760100051f5f0100051f480100051f310100051f1a0100051f030100051fec0100051fd50100051fbe0100051fa701000050a7a7a7a7a7560000001f000100051f030100051f070100051f0b0100051f0f0100051f130100051f170100051f1b0100051f1f0100051f230100051f270100051f2b0100051f2e0100051f320100051f360100051f3a010000503a3a3a3a3a",
    ),
    (
        "lz4hc",
        "0201200220030000200300008700000014000000350000001f0001001e2fe90302001d2fd20702001d2fbb0b02001d2fa40f02001d2f8d1302001d2f761702001d2f5f1b020018501b5f1b5f1b360000002f481f02001d2f312302001d2f1a2702001d2f032b02001d2fec2e02001d2fd53202001d2fbe3602001d2fa73a020018503aa73aa73a",
    ),
    (
        "zlib",
        "02016102200300002003000087000000140000003600000078da6360c0015ee202977081ddb8c0125ca0171728c305e271010f5cc0101790c20598718137b8c0555c601f2eb01c170000a39acd793500000078da6360c001987101765c801b17e0c705847101715c401a1790c705947101755c401b17d0c3058c7001335cc00a17000099dc2d06",
    ),
    (
        "zstd in two blocks",
        "02019102200300000002000078000000180000004d0000003100000028b52ffd6000013d0100d800e9d2bba48d765f48311a0003070b0f13171b1f2327272727272715580100101ae17f3f1e072700000028b52ffd602000ed0000681a03ecd5bea7272b2e32363a3a0c9810f00e0010fe3531e40301971c",
    ),
    (
        "zstd, bits",
        "020194022003000020030000a6000000140000008e00000028b52ffd602002250400b2470e12d0670da42e46100120f6014e11b91b84ca14659eaaea92f0af08f38e1a5e55fc5355f097aa18462a30ff911fd595ea46119f124e0a78a90220a051b513aca8fbdbc06e020aeb0180d26498ca87df6c1c97f3a8271979616c189b917ce5e6428ee3fa08c9eda1a22529c639f2da6076ffd438e687b601301093c1d71560ccb02a",
    ),
    (
        "lz4, bits",
        "0201240220030000200300004501000014000000b4000000ff0a000000feffff030000f8ffff0f0000e0ffff3f000080ffffff19000950000000fcff0100110f0c0010c00b000132000f19000902020010f02a000402000213000202000c19000f96000341ffffff017d0011073200111f7d00127f42000f7d000611fe38001107220011e00c000332000564001bff4b0002190017006400000200021301054b0011007d000302001101100002320011ff4501030200027d00050200133f170007020004fa0050ffffffffff750000005f000000feff01000d2a0f0001000f32000f090200023d00ff08fcffff070000f0ffff1f0000c0ffff7f000000ffffff0119000205020011f84900111f100011800c000032000f19000001150006020012e02c00020200160118000719000715000d02000fe100030d27000f02003b500000000000",
    ),
];

fn plain() -> Vec<u8> {
    (0..400_u16).flat_map(|i| (i / 25 * 1001).to_le_bytes()).collect()
}

fn packed(which: usize) -> Vec<u8> {
    let digits = PACKED[which].1;
    let byte = |at| u8::from_str_radix(&digits[at..at + 2], 16).unwrap();
    (0..digits.len()).step_by(2).map(byte).collect()
}

#[test]
fn every_way_of_packing_is_undone() {
    for (which, (name, _)) in PACKED.iter().enumerate() {
        assert_eq!(unpacked(&packed(which), 800).unwrap(), plain(), "{name}");
        assert!(unpacked(&packed(which), 799).unwrap_err().contains("799"), "{name}");
    }
}

#[test]
fn what_was_left_as_it_is_is_copied() {
    let head = [2, 1, 2, 2, 3, 0, 0, 0, 3, 0, 0, 0, 19, 0, 0, 0];
    assert_eq!(unpacked(&[&head[..], &[7, 8, 9]].concat(), 3).unwrap(), [7, 8, 9]);
    assert!(unpacked(&[&head[..], &[7, 8]].concat(), 3).is_err());
}

#[test]
fn no_part_of_a_container_is_whole() {
    for (which, (name, _)) in PACKED.iter().enumerate() {
        let bytes = packed(which);
        for length in 0..bytes.len() {
            assert!(unpacked(&bytes[..length], 800).is_err(), "{name} at {length}");
        }
    }
}

#[test]
fn what_is_not_read_is_named_with_a_remedy() {
    let mut bytes = packed(2);
    bytes[2] = bytes[2] & 31 | 2 << 5;
    let problem = unpacked(&bytes, 800).unwrap_err();
    assert!(problem.contains("Snappy") && problem.contains("`cname`"), "{problem}");
    bytes[0] = 5;
    assert!(unpacked(&bytes, 800).unwrap_err().contains("Blosc's format 5"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_bytes_of_a_container_never_panic(
        which in 0..8_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut bytes = packed(which);
        let length = bytes.len();
        for (at, value) in &changes {
            bytes[at.index(length)] = *value;
        }
        if let Ok(unpacked) = unpacked(&bytes, 4096) {
            prop_assert!(unpacked.len() <= 4096);
        }
    }
}
