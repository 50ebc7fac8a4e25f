import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from google.protobuf.descriptor_pb2 import FileDescriptorSet
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from trialid.export.tracks import CHUNK
from trialid.names import labels
from trialid.names.quantities import SIGNALS
from trialid.report.files.overlay import write_mcap
from trialid.result.json_file import plain, result_of


@pytest.fixture(scope="module")
def path(tmp_path_factory, result, series):
    path = tmp_path_factory.mktemp("overlay") / "predicted.mcap"
    write_mcap(path, result_of(result), series)
    return path


@pytest.fixture(scope="module")
def topics(path):
    """Topic to its log times and messages, as a plot tool would read them."""
    read = {}
    with path.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()], validate_crcs=True)
        for _, channel, message, decoded in reader.iter_decoded_messages():
            read.setdefault(channel.topic, []).append((message.log_time, decoded))
    return read


def column(messages, field):
    return np.array([getattr(message, field) for _, message in messages])


def test_what_is_read_back_is_what_was_written(topics, series):
    for trial in series:
        stem = f"/trialid/{trial.name}/"
        assert np.array_equal(column(topics[stem + "inputs"], "rudder_rad"), trial.inputs["delta"])
        for output in trial.outputs:
            field = labels.message_field(output.name)
            for role, values in (
                ("measured", output.observed),
                ("predicted", output.predicted),
                ("residual", output.residual),
            ):
                read = column(topics[stem + role], field)
                assert np.array_equal(read, values, equal_nan=True)


def test_log_time_and_stamp_are_trial_time(topics, series):
    messages = topics["/trialid/zigzag-20/predicted"]
    expected = np.rint(series[1].t * 1e9).astype(np.int64)
    assert np.array_equal([t for t, _ in messages], expected)
    assert np.array_equal([m.timestamp.ToNanoseconds() for _, m in messages], expected)


def test_schema_brings_the_time_stamp_it_needs(path):
    with path.open("rb") as stream:
        schemas = make_reader(stream).get_summary().schemas.values()
    assert {schema.name for schema in schemas} == {"trialid.Inputs", "trialid.Outputs"}
    for schema in schemas:
        files = FileDescriptorSet.FromString(schema.data).file
        assert files[0].name == "google/protobuf/timestamp.proto"
        assert list(files[-1].dependency) == ["google/protobuf/timestamp.proto"]


def test_chunks_are_small_and_do_not_overlap(path):
    with path.open("rb") as stream:
        chunks = make_reader(stream).get_summary().chunk_indexes
    assert max(chunk.uncompressed_size for chunk in chunks) < 1.1 * CHUNK
    ends = [(chunk.message_start_time, chunk.message_end_time) for chunk in chunks]
    assert all(end <= start for (_, end), (start, _) in pairwise(ends))


def test_manifest_and_result_travel_along(path, result):
    with path.open("rb") as stream:
        reader = make_reader(stream)
        (manifest,) = reader.iter_metadata()
        (attachment,) = reader.iter_attachments()
    assert manifest.name == "trialid"
    assert manifest.metadata["pipeline"] == result["pipeline"]
    assert manifest.metadata["sha256 ../logs/zigzag-10.mcap"] == "a" * 64
    assert (attachment.name, attachment.media_type) == ("result.json", "application/json")
    travelled = json.loads(attachment.data)
    assert travelled == json.loads(json.dumps(plain(result_of(result))))
    assert travelled["fit"]["eps_rmsn"] == result["fit"]["eps_rmsn"]


def test_the_same_run_gives_the_same_bytes(path, tmp_path, result, series):
    write_mcap(tmp_path / "again.mcap", result_of(result), series)
    assert (tmp_path / "again.mcap").read_bytes() == path.read_bytes()


def test_names_no_plot_tool_takes_are_replaced_and_kept_apart(tmp_path, series):
    odd = [replace(series[0], name=name) for name in ("a b", "a/b", "<script>")]
    write_mcap(tmp_path / "odd.mcap", result_of({}), odd)
    with (tmp_path / "odd.mcap").open("rb") as stream:
        channels = make_reader(stream).get_summary().channels.values()
    stems = {channel.topic.split("/")[2] for channel in channels}
    assert stems == {"a_b", "a_b_", "_script_"}


def test_a_time_before_zero_is_refused_before_the_file_is_lost(tmp_path, series):
    early = replace(series[0], t=series[0].t - 1.0)
    with pytest.raises(ValueError, match="before its time zero"):
        write_mcap(tmp_path / "early.mcap", result_of({}), [early])


def test_every_signal_has_its_own_field_name():
    fields = [labels.message_field(name) for name in SIGNALS]
    assert len(set(fields)) == len(fields)
    assert all(field.isidentifier() for field in fields)
