raise ValueError("\x1b[2J\x1b[31mpassed\x07 ::error::x [bold]bracket[/bold] [/]")
