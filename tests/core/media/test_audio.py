import io
import struct
import wave

import numpy as np
import pytest
import soundfile

from core.errors import UserFacingError
from core.media.audio import Audio, audio_from_bytes, encode_flac, load_audio, resampled, write_wav


def tone(rate_hz, duration_s=0.5, frequency_hz=440.0, level=0.5):
    return (level * np.sin(2 * np.pi * frequency_hz * np.arange(round(rate_hz * duration_s)) / rate_hz)).astype("f4")


@pytest.mark.parametrize(
    ("suffix", "format_", "subtype", "tolerance"),
    [
        ("wav", "WAV", "PCM_U8", 1 / 100),
        ("wav", "WAV", "PCM_16", 1e-4),
        ("wav", "WAV", "PCM_24", 1e-6),
        ("wav", "WAV", "FLOAT", 1e-7),
        ("wav", "WAVEX", "PCM_24", 1e-6),
        ("flac", "FLAC", "PCM_24", 1e-6),
        ("ogg", "OGG", "VORBIS", 0.05),
        ("aiff", "AIFF", "PCM_16", 1e-4),
    ],
)
@pytest.mark.parametrize(("rate_hz", "channels"), [(8000, 1), (44100, 2), (96000, 6)])
def test_every_kind_of_file_gives_the_same_sound(tmp_path, suffix, format_, subtype, tolerance, rate_hz, channels):
    path = tmp_path / f"a.{suffix}"
    sound = tone(rate_hz)
    soundfile.write(path, np.repeat(sound[:, None], channels, axis=1), rate_hz, format=format_, subtype=subtype)
    audio = load_audio(path)
    assert (audio.rate_hz, audio.path, audio.samples.dtype) == (rate_hz, path, np.float32)
    assert audio.duration_s == pytest.approx(0.5)
    assert np.abs(audio.samples - sound).max() < tolerance


def test_channels_are_averaged_across_blocks(tmp_path):
    path = tmp_path / "a.wav"
    n = 200_000
    left, right = np.linspace(-0.5, 0.5, n), np.linspace(0.25, 0, n)
    soundfile.write(path, np.stack([left, right], axis=1), 48_000, subtype="FLOAT")
    np.testing.assert_allclose(load_audio(path).samples, (left + right) / 2, atol=1e-6)


def test_a_wav_of_the_standard_library_is_read_sample_by_sample(tmp_path):
    path = tmp_path / "a.wav"
    pcm = np.arange(-8000, 8000, dtype="<i2")
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1), file.setsampwidth(2), file.setframerate(16_000)
        file.writeframes(pcm.tobytes())
    np.testing.assert_array_equal(load_audio(path).samples, pcm / np.float32(32768))


def test_a_streamed_wav_that_promises_no_length_is_read(tmp_path):
    path = tmp_path / "piped.wav"
    buffer = io.BytesIO()
    soundfile.write(buffer, tone(16_000), 16_000, format="WAV", subtype="PCM_16")
    raw = bytearray(buffer.getvalue())
    struct.pack_into("<I", raw, 4, 0xFFFFFFFF)
    struct.pack_into("<I", raw, raw.index(b"data") + 4, 0xFFFFFFFF)
    path.write_bytes(raw)
    assert load_audio(path).duration_s == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("format_", "subtype"),
    [
        ("WAV", "PCM_U8"),
        ("WAV", "FLOAT"),
        ("WAV", "IMA_ADPCM"),
        ("RF64", "PCM_16"),
        ("FLAC", "PCM_16"),
        ("OGG", "VORBIS"),
        ("OGG", "OPUS"),
        ("AIFF", "PCM_16"),
    ],
)
@pytest.mark.parametrize("kept", [0.9, 0.5, 0.1, 0.001])
def test_a_truncated_file_is_refused_by_name(tmp_path, format_, subtype, kept):
    buffer = io.BytesIO()
    noise = np.random.default_rng(0).normal(0, 0.1, 96_000).clip(-1, 1)
    soundfile.write(buffer, noise, 48_000, format=format_, subtype=subtype)
    path = tmp_path / "cut.wav"
    path.write_bytes(buffer.getvalue()[: int(kept * len(buffer.getvalue()))])
    with pytest.raises(UserFacingError, match=r"cut\.wav"):
        load_audio(path)


def wav_bytes(samples, rate_hz=16_000):
    buffer = io.BytesIO()
    soundfile.write(buffer, samples, rate_hz, format="WAV", subtype="FLOAT")
    return buffer.getvalue()


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is empty"),
        (b"RIFF", "damaged"),
        (b"\x89PNG\r\n\x1a\n" + bytes(500), "damaged"),
        (b"hello, this is not sound\n" * 50, "damaged"),
        (wav_bytes(np.zeros(0, "f4")), "lasts 0.000 s"),
        (wav_bytes(tone(16_000, 0.01)), "lasts 0.010 s"),
        (wav_bytes(np.r_[tone(16_000), np.nan, tone(16_000)].astype("f4")), "not finite numbers"),
        (wav_bytes(np.r_[tone(16_000), np.inf].astype("f4")), "not finite numbers"),
        (wav_bytes(np.zeros(4000, "f4"), 100), "a rate of 100 Hz"),
        (wav_bytes(np.zeros(4000, "f4"), 2_000_000), "a rate of 2000000 Hz"),
    ],
)
def test_bad_content_is_one_sentence_naming_the_file(tmp_path, content, says):
    path = tmp_path / "bad.wav"
    path.write_bytes(content)
    with pytest.raises(UserFacingError, match=says) as caught:
        load_audio(path)
    assert "bad.wav" in caught.value.message
    assert "\n" not in caught.value.message


@pytest.mark.parametrize("name", ["bad.mp3", "noextension", "bad.flac"])
def test_the_name_of_a_file_does_not_confuse_the_reader(tmp_path, name):
    path = tmp_path / name
    path.write_bytes(b"12345" * 1000)
    with pytest.raises(UserFacingError, match=name):
        load_audio(path)
    path.write_bytes(wav_bytes(tone(16_000)))
    assert load_audio(path).duration_s == pytest.approx(0.5)


def test_a_missing_file_and_a_folder_are_said(tmp_path):
    with pytest.raises(UserFacingError, match=r"no audio file '.*none\.wav'"):
        load_audio(tmp_path / "none.wav")
    with pytest.raises(UserFacingError, match="is not a file"):
        load_audio(tmp_path)


def test_a_header_that_claims_hours_is_refused_before_memory_is_asked_for(tmp_path):
    buffer = io.BytesIO()
    soundfile.write(buffer, tone(16_000), 16_000, format="FLAC", subtype="PCM_16")
    raw = bytearray(buffer.getvalue())
    raw[21] |= 0x0F  # the top bits of STREAMINFO's 36-bit count of samples
    path = tmp_path / "a.flac"
    path.write_bytes(raw)
    with pytest.raises(UserFacingError, match=r"a\.flac"):
        load_audio(path)


@pytest.mark.parametrize("rate_hz", [8_000, 16_000, 44_100, 96_000])
def test_resampling_keeps_a_tone_and_its_length(rate_hz):
    sound = Audio(tone(48_000, 1.0), 48_000)
    again = resampled(sound, rate_hz)
    assert again.rate_hz == rate_hz
    assert again.duration_s == pytest.approx(1.0, abs=1e-3)
    middle = slice(rate_hz // 4, rate_hz // 2)
    np.testing.assert_allclose(again.samples[middle], tone(rate_hz, 1.0)[middle], atol=2e-3)


def test_flac_bytes_hold_the_sound_to_16_bits():
    audio = Audio(tone(22_050), 22_050)
    again = audio_from_bytes(encode_flac(audio))
    assert again.rate_hz == 22_050
    assert np.abs(again.samples - audio.samples).max() <= 1 / 32768
    with pytest.raises(UserFacingError, match="embedded sound"):
        audio_from_bytes(encode_flac(audio)[:500])


def test_a_written_wav_is_read_back_and_loud_sound_is_clipped(tmp_path):
    path = tmp_path / "out.wav"
    write_wav(Audio(tone(16_000, level=2.0), 16_000), path)
    again = load_audio(path).samples
    assert np.abs(again - tone(16_000, level=2.0).clip(-1, 1)).max() <= 1 / 16384
    assert [p.name for p in tmp_path.iterdir()] == ["out.wav"]


def test_what_cannot_be_written_leaves_nothing_behind(tmp_path):
    audio = Audio(tone(16_000), 16_000)
    with pytest.raises(UserFacingError, match="cannot be written"):
        write_wav(audio, tmp_path / "nowhere" / "out.wav")
    (tmp_path / "folder.wav").mkdir()
    with pytest.raises(UserFacingError, match="cannot be written"):
        write_wav(audio, tmp_path / "folder.wav")
    assert [p.name for p in tmp_path.iterdir()] == ["folder.wav"]


def test_a_raw_file_is_refused_since_its_rate_is_unknown(tmp_path):
    path = tmp_path / "a.raw"
    path.write_bytes(bytes(5000))
    with pytest.raises(UserFacingError, match=r"a\.raw"):
        load_audio(path)
