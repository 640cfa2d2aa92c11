"""What the machine offers: files that are read and written whole, what is kept between runs, threads, processes."""
