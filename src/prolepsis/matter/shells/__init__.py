"""What has a shell: it breaks, dents and opens."""
