# Filled once the targets exist.
