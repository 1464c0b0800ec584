"""Reads a folder of write_events with TensorBoard's own reader and checks what it understood."""
import io
import sys

from PIL import Image
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator


def check(name, actual, expected):
    if actual != expected:
        sys.exit(f"read_events: {name}: expected {expected}, got {actual}")


def main():
    events = EventAccumulator(sys.argv[1])
    events.Reload()
    tags = events.Tags()
    check("images", tags["images"], ["depth"])
    check("scalars", tags["scalars"], ["loss/total"])
    check("histograms", sorted(tags["histograms"]), ["nothing", "weights"])
    check("tensors", tags["tensors"], ["config"])

    # The first file's steps 6 to 10 are void since the run went on after step 5.
    scalars = events.Scalars("loss/total")
    check("steps", [e.step for e in scalars], list(range(1, 9)))
    check("kept values", [round(e.value, 6) for e in scalars[:5]], [round(1 / s, 6) for s in range(1, 6)])
    check("new values", [e.value for e in scalars[5:]], [106.0, 107.0, 108.0])
    check("wall times rise", all(a.wall_time < b.wall_time for a, b in zip(scalars, scalars[1:])), True)

    (image,) = events.Images("depth")
    check("image size", (image.width, image.height), (64, 48))
    picture = Image.open(io.BytesIO(image.encoded_image_string))
    check("picture size", picture.size, (64, 48))
    check("picture colour", picture.getpixel((10, 10)), (0, 0, 255))

    (histogram,) = events.Histograms("weights")
    value = histogram.histogram_value
    check("histogram", (value.min, value.max, value.num, value.sum), (-1.0, 3.0, 4.0, 2.5))
    check("histogram total", sum(value.bucket), 4.0)
    check("histogram limits", len(value.bucket_limit), len(value.bucket))
    check("empty histogram", events.Histograms("nothing")[0].histogram_value.num, 0.0)

    (text,) = events.Tensors("config")
    check("text", text.tensor_proto.string_val[0].decode(), "# Run\n**bold** \u00b5")
    check("plugin", events.SummaryMetadata("config").plugin_data.plugin_name, "text")
    print("read_events: all as written")


main()
