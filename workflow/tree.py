# SPDX-License-Identifier: Apache-2.0
"""A binary tree over leaves in a given order: node INDEX of LEVEL stands over 2^(LEVEL + 1) leaves."""


def level_and_index(node):
    level, index = node.split("-")
    return int(level), int(index)


def _nodes(leaves, level):
    return -(-leaves // 2 ** (level + 1))


def root(leaves):
    """The node over all leaves."""
    level = 0
    while _nodes(leaves, level) > 1:
        level += 1
    return f"{level}-0"


def children(leaves, level, index):
    """The nodes below a node of a level above 0."""
    below = _nodes(leaves, level - 1)
    return [f"{level - 1}-{child}" for child in (2 * index, 2 * index + 1) if child < below]


def leaves_below(leaves, level, index):
    width = 2 ** (level + 1)
    return leaves[index * width:(index + 1) * width]
