"""Scenes from arrays."""


def create_scene(positions, indices, keywords):
    raise NotImplementedError


def from_trimesh(mesh):
    raise NotImplementedError
