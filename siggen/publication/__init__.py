"""A finished set as a folder that repositories take: card, metadata, licence, previews."""
