"""Spaces: Gymnasium's where it can be imported, else two of our own that keep to its documented interface."""

import collections

import numpy as np

try:
    from gymnasium.spaces import Box, Dict
except ImportError:

    class _Space:
        """What Box and Dict share: a generator of their own."""

        def __init__(self, shape, dtype, seed):
            self._shape, self.dtype = shape, dtype
            self._np_random = None
            if seed is not None:
                self.seed(seed)

        @property
        def shape(self):
            return self._shape

        @property
        def np_random(self):
            if self._np_random is None:
                self.seed()
            return self._np_random

        def seed(self, seed=None):
            """Returns the seed that was used."""
            sequence = np.random.SeedSequence(seed)
            self._np_random = np.random.Generator(np.random.PCG64(sequence))
            return sequence.entropy

        def __contains__(self, value):
            return self.contains(value)

    class Box(_Space):
        """A box of numbers, bounds included."""

        def __init__(self, low, high, shape=None, dtype=np.float32, seed=None):
            shape = tuple(shape) if shape is not None else np.broadcast(low, high).shape
            super().__init__(shape, np.dtype(dtype), seed)
            self.low = (
                np.full(shape, low, dtype=dtype) if np.ndim(low) == 0 else np.asarray(low, dtype=dtype).reshape(shape)
            )
            self.high = (
                np.full(shape, high, dtype=dtype)
                if np.ndim(high) == 0
                else np.asarray(high, dtype=dtype).reshape(shape)
            )

        def sample(self, mask=None):
            """Uniform where bounded; normal where not."""
            if mask is not None:
                raise ValueError("Box.sample takes no mask.")
            low, high = self.low.astype(np.float64), self.high.astype(np.float64)
            bounded = np.isfinite(low) & np.isfinite(high)
            uniform = self.np_random.uniform(np.where(bounded, low, 0), np.where(bounded, high, 1))
            return np.clip(np.where(bounded, uniform, self.np_random.normal(size=self.shape)), low, high).astype(
                self.dtype
            )

        def contains(self, value):
            value = np.asarray(value)
            return bool(
                np.can_cast(value.dtype, self.dtype)
                and value.shape == self.shape
                and np.all(value >= self.low)
                and np.all(value <= self.high)
            )

        def __eq__(self, other):
            return (
                isinstance(other, Box)
                and self.shape == other.shape
                and self.dtype == other.dtype
                and np.array_equal(self.low, other.low)
                and np.array_equal(self.high, other.high)
            )

        def __repr__(self):
            return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"

    class Dict(_Space, collections.abc.Mapping):
        """Named spaces, in the order of their names."""

        def __init__(self, spaces=None, seed=None, **more):
            self.spaces = dict(sorted({**dict(spaces or {}), **more}.items()))
            super().__init__(None, None, seed)

        def seed(self, seed=None):
            used = super().seed(seed)
            return (
                {name: space.seed(int(self._np_random.integers(2**31))) for name, space in self.spaces.items()}
                if used is not None
                else {}
            )

        def sample(self, mask=None):
            return {name: space.sample(None if mask is None else mask[name]) for name, space in self.spaces.items()}

        def contains(self, value):
            return (
                isinstance(value, dict)
                and value.keys() == self.spaces.keys()
                and all(space.contains(value[name]) for name, space in self.spaces.items())
            )

        def __getitem__(self, name):
            return self.spaces[name]

        def __iter__(self):
            return iter(self.spaces)

        def __len__(self):
            return len(self.spaces)

        def __eq__(self, other):
            return isinstance(other, Dict) and self.spaces == other.spaces

        def __repr__(self):
            return f"Dict({self.spaces})"


def batch(space, count):
    """`count` of the space side by side, as Gymnasium's vector environments have them."""
    if isinstance(space, Dict):
        return Dict({name: batch(inner, count) for name, inner in space.spaces.items()})
    repeat = (count,) + (1,) * space.low.ndim
    return Box(np.tile(space.low, repeat), np.tile(space.high, repeat), dtype=space.dtype)
