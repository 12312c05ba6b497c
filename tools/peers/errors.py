"""Noise and bias of estimates, each apart from the other, relative to the mean."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class ImageError:
    """Root mean squares over the pixels, relative to the image's mean."""

    # Standard deviation of the sampling noise of one image.
    noise: float
    # Constant difference from the truth; its square can turn out negative, which is 0 here.
    bias: float
    # Bias at which noise alone would be found with a probability of 0.3 %.
    detectable_bias: float


class Truth:
    """Mean of two independent images; `variance` is the mean square of its own noise."""

    def __init__(self, first: np.ndarray, second: np.ndarray):
        self.image = 0.5 * (first + second)
        self.mean = float(np.mean(self.image))
        self.variance = float(np.mean((first - second) ** 2)) / 4.0

    def error(self, images: list[np.ndarray]) -> ImageError:
        """Error of independent images of the same number of samples.

        Noise is half the mean square difference of two images. The product of the errors of two images has the
        squared bias, plus the noise of the truth, as its expectation: their own noise cancels.
        """
        noise, products = [], []
        for i, first in enumerate(images):
            for second in images[:i]:
                known = np.isfinite(first) & np.isfinite(second)
                noise.append(np.mean((first[known] - second[known]) ** 2) / 2.0)
                products.append((first - self.image)[known] * (second - self.image)[known] - self.variance)
        squared_bias = float(np.mean([np.mean(product) for product in products]))
        deviation = float(np.mean([np.std(product) / np.sqrt(product.size) for product in products]))
        return ImageError(
            noise=float(np.sqrt(np.mean(noise))) / self.mean,
            bias=float(np.sqrt(max(squared_bias, 0.0))) / self.mean,
            detectable_bias=float(np.sqrt(3.0 * deviation)) / self.mean,
        )


@dataclass(frozen=True)
class DirectionErrors:
    """Relative errors; shapes [view, band], and [band] for means over the views."""

    # Of one run.
    variance: np.ndarray
    # Mean of all runs over the reference, less 1, and its standard error.
    bias: np.ndarray
    bias_error: np.ndarray
    mean_bias: np.ndarray
    mean_bias_error: np.ndarray

    def noise(self) -> np.ndarray:
        """Root mean square over the views, shape [band]."""
        return np.sqrt(self.variance.mean(axis=0))


def mean_and_variance(runs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mean over the runs, the first axis, and the variance of that mean."""
    return runs.mean(axis=0), runs.var(axis=0, ddof=1) / len(runs)


def direction_errors(runs: np.ndarray, reference: np.ndarray) -> DirectionErrors:
    """Errors of independent runs against independent runs of the reference; shapes [run, view, band]."""
    true_mean = reference.mean(axis=0)

    ratios, reference_ratios = runs / true_mean, reference / true_mean
    mean, mean_variance = mean_and_variance(ratios)
    _, reference_variance = mean_and_variance(reference_ratios)
    # Views of a run share its packets, so that their errors are correlated.
    over_views, over_views_variance = mean_and_variance(ratios.mean(axis=1))
    _, reference_over_views = mean_and_variance(reference_ratios.mean(axis=1))
    return DirectionErrors(
        variance=mean_variance * len(runs),
        bias=mean - 1.0,
        bias_error=np.sqrt(mean_variance + reference_variance),
        mean_bias=over_views - 1.0,
        mean_bias_error=np.sqrt(over_views_variance + reference_over_views),
    )


def samples_times_variance(counts: list[int], noise: list[float]) -> tuple[float, float]:
    """Fit of `noise² = c / N^p`: c at p = 1 (mean of noise² N), and p (1 for independent samples)."""
    squares = np.array(noise) ** 2
    constant = float(np.mean(squares * counts))
    if len(counts) < 2:
        return constant, 1.0
    return constant, float(-np.polyfit(np.log(counts), np.log(squares), 1)[0])
