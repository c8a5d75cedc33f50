"""The import assistant: a studio's captures in, step by step."""
