"""The training losses of losses/ and what they compare with in Python, for experiments and comparison.

`terms(config, batch, prediction_m, input_m)` is TrainingLoss of losses/training_loss.hpp; tests hold the two equal.
`config` is a resolved configuration of alight-train (--print-config) as a dictionary; `batch` is a dictionary with the
fields of train/data/batch.hpp. All depths are plane depths [B,1,H,W] in metres, 0 = missing.
"""

import torch
import torch.nn.functional as F

# --- means -------------------------------------------------------------------------------------------------------


def sample_means(value, mask):
    """[B,...] -> means of the samples [B] over their masked pixels, and whether they have any [B]."""
    count = mask.flatten(1).sum(1)
    total = torch.where(mask, value, torch.zeros_like(value)).flatten(1).sum(1)
    return total / count.clamp_min(1), count > 0


def mean_over_samples(means, any_pixel):
    there = any_pixel.to(means.dtype)
    return (means * there).sum() / there.sum().clamp_min(1)


def masked_mean(value, mask):
    return mean_over_samples(*sample_means(value, mask))


# --- supervised --------------------------------------------------------------------------------------------------


def depth_loss(prediction_m, target_m, error):
    known = target_m > 0
    if error == "log":
        safe_m = torch.where(known, target_m, torch.ones_like(target_m))
        return masked_mean((prediction_m / safe_m).log().abs(), known)
    square, any_pixel = sample_means((prediction_m - target_m).square(), known)
    if error == "rmse":
        square = (square + 1e-6).sqrt() - 1e-3
    return mean_over_samples(square, any_pixel)


def ratio_loss(prediction_m, target_m):
    known = target_m > 0
    safe_m = torch.where(known, target_m, torch.ones_like(target_m))
    return masked_mean((prediction_m - target_m).abs() / safe_m, known)


def drop_hidden_points(sparse_m, offset_s, window_px, min_offset_s, margin):
    """Ground truth without points that may lie behind what the image shows (train/data/occlusion_filter.hpp)."""
    if window_px == 0:
        return sparse_m
    nearness = torch.where(sparse_m > 0, 1 / sparse_m.clamp_min(1e-3), torch.zeros_like(sparse_m))
    nearest = F.max_pool2d(nearness, window_px, 1, window_px // 2)
    hidden = (nearness < nearest * (1 - margin)) & (offset_s.abs() > min_offset_s)
    return torch.where(hidden, torch.zeros_like(sparse_m), sparse_m)


# --- photometric -------------------------------------------------------------------------------------------------


def ssim_map(a, b):
    x, y = F.pad(a, (1, 1, 1, 1), mode="reflect"), F.pad(b, (1, 1, 1, 1), mode="reflect")
    mean = lambda z: F.avg_pool2d(z, 3, 1)
    mean_x, mean_y = mean(x), mean(y)
    variance_x, variance_y = mean(x * x) - mean_x * mean_x, mean(y * y) - mean_y * mean_y
    covariance = mean(x * y) - mean_x * mean_y
    c1, c2 = 0.01**2, 0.03**2
    numerator = (2 * mean_x * mean_y + c1) * (2 * covariance + c2)
    return numerator / ((mean_x**2 + mean_y**2 + c1) * (variance_x + variance_y + c2))


def synthesise_view(source, depth_m, intrinsics_px, T_source_target):
    """The target's view drawn with the source's colours [B,C,H,W], and where the source sees it [B,1,H,W] bool."""
    height, width = source.shape[2:]
    fx, fy, cx, cy = (k.view(-1, 1, 1) for k in intrinsics_px.unbind(1))
    z = depth_m.squeeze(1)
    u = torch.arange(width, dtype=z.dtype).view(1, 1, -1)
    v = torch.arange(height, dtype=z.dtype).view(1, -1, 1)
    x, y = (u - cx) / fx * z, (v - cy) / fy * z
    t = lambda row, column: T_source_target[:, row, column].view(-1, 1, 1)
    source_x, source_y, source_z = (t(i, 0) * x + t(i, 1) * y + t(i, 2) * z + t(i, 3) for i in range(3))
    safe_z = source_z.clamp_min(1e-3)
    source_u, source_v = fx * source_x / safe_z + cx, fy * source_y / safe_z + cy
    inside = lambda p, size: (p >= -1e-3) & (p <= size - 1 + 1e-3)
    valid = (source_z > 1e-3) & inside(source_u, width) & inside(source_v, height)
    grid = torch.stack([source_u * (2.0 / (width - 1)) - 1.0, source_v * (2.0 / (height - 1)) - 1.0], 3)
    image = F.grid_sample(source, grid, mode="bilinear", padding_mode="border", align_corners=True)
    return image, valid.unsqueeze(1)


def photometric_error(a, b, ssim_weight):
    dissimilarity = (1 - ssim_map(a, b)) / 2
    return (ssim_weight * dissimilarity + (1 - ssim_weight) * (a - b).abs()).mean(1, keepdim=True)


def photometric_sources(config, batch):
    """Image, T_source_left and presence of each source that is used and that a sample of the batch has."""
    T_right_left = torch.eye(4).repeat(len(batch["baseline_m"]), 1, 1)
    T_right_left[:, 0, 3] = -batch["baseline_m"]
    poses = {"previous": batch["T_previous_camera"], "next": batch["T_next_camera"], "right": T_right_left}
    sources = [(batch[n], T, batch["has_" + n]) for n, T in poses.items() if config["use_" + n]]
    return [source for source in sources if source[2].any()]


def photometric_loss(config, batch, depth_m):
    errors, counts = [], []
    for image, T_source_left, present in photometric_sources(config, batch):
        view, valid = synthesise_view(image, depth_m, batch["intrinsics_px"], T_source_left)
        errors.append(photometric_error(view, batch["left"], config["ssim_weight"]))
        counts.append(valid & present.view(-1, 1, 1, 1))
    if not errors:
        return depth_m.sum() * 0
    if config["reduction"] == "mean":
        means, there = zip(*(sample_means(e, c) for e, c in zip(errors, counts)))
        return masked_mean(torch.stack(means, 1), torch.stack(there, 1))
    candidates = [torch.where(c, e, torch.full_like(e, 1e6)) for e, c in zip(errors, counts)]
    return masked_mean(torch.cat(candidates, 1).amin(1, True), torch.cat(counts, 1).any(1, True))


# --- smoothness --------------------------------------------------------------------------------------------------


def smoothness_loss(config, depth_m, image):
    weight_x = weight_y = None
    if config["edge_aware"]:
        weight = lambda dim: torch.exp(-config["edge_sharpness"] * image.diff(dim=dim).abs().mean(1, True))
        weight_x, weight_y = weight(3), weight(2)

    def weighed(value, weight):
        value = value.abs()
        if weight is not None:
            value = value * weight[:, :, : value.shape[2], : value.shape[3]]
        return value.mean()

    surface = depth_m.log() if config["relative"] else depth_m
    dx, dy = surface.diff(dim=3), surface.diff(dim=2)
    first = weighed(dx, weight_x) + weighed(dy, weight_y)
    second = weighed(dx.diff(dim=3), weight_x) + weighed(dy.diff(dim=2), weight_y)
    return first + second + 2 * weighed(dx.diff(dim=2), weight_x)


# --- all ---------------------------------------------------------------------------------------------------------


def terms(config, batch, prediction_m, input_m):
    """Every term before weighting and their weighted sum "total"; terms of weight 0 are left out."""
    loss = config["loss"]
    target_m = drop_hidden_points(batch["sparse_m"], batch["offset_s"], **config["occlusion_filter"])
    if loss["target"] == "input":
        target_m = input_m
    elif loss["target"] == "held_out":
        target_m = torch.where(input_m > 0, torch.zeros_like(input_m), target_m)
    functions = {
        "depth": lambda: depth_loss(prediction_m, target_m, loss["depth_error"]),
        "ratio": lambda: ratio_loss(prediction_m, target_m),
        "photometric": lambda: photometric_loss(loss["photometric"], batch, prediction_m),
        "smoothness": lambda: smoothness_loss(loss["smoothness"], prediction_m, batch["left"]),
    }
    result = {n: f() for n, f in functions.items() if loss[n + "_weight"] > 0}
    result["total"] = sum(loss[n + "_weight"] * term for n, term in result.items())
    return result
